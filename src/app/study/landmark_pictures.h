#pragma once

#include <cstdint>
#include <vector>

#include "app/study/landmark_methods.h"
#include "render/report/blocks.h"

namespace patrol::app {

/// One seed in pictures: position error over time of all methods, and of the first, the last with particles and the last of all the path and the
/// landmarks beside the true ones.
std::vector<render::Section> landmark_sections(const LandmarkWorld& world, const std::vector<LandmarkMethod>& methods, std::uint64_t seed);

}  // namespace patrol::app
