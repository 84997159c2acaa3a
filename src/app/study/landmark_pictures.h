#pragma once

#include <cstdint>
#include <vector>

#include "app/study/landmark_methods.h"
#include "render/report/blocks.h"

namespace patrol::app {

/// One seed in pictures: position error over time, and of the first four methods and the last one path and landmarks beside the true ones. Of methods with
/// particles those with as many as the first.
std::vector<render::Section> landmark_sections(const LandmarkWorld& world, const std::vector<LandmarkMethod>& methods, std::uint64_t seed);

}  // namespace patrol::app
