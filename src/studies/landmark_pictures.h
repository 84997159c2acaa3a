#pragma once

#include <cstdint>
#include <vector>

#include "report/blocks.h"
#include "studies/landmark_methods.h"

namespace patrol::studies {

/// Figures of one seed: position error over time; path and landmarks compared with the ground truth for the first four
/// methods and the last one. Of methods with particles, those with the particle number of the first method.
std::vector<report::Section> landmark_sections(const LandmarkWorld& world, const std::vector<LandmarkMethod>& methods,
                                               std::uint64_t seed);

}  // namespace patrol::studies
