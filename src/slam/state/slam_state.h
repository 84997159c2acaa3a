#pragma once

#include "core/state/state_archive.h"
#include "slam/graph/submap.h"
#include "slam/grid_map.h"
#include "slam/rbpf/particle.h"

namespace patrol {

template <>
struct StateMaker<slam::GridMap> {
  static slam::GridMap make() { return {1.0, 1.0}; }
};

template <>
struct StateMaker<slam::LikelihoodPyramid> {
  static slam::LikelihoodPyramid make() { return {slam::GridMap(1.0, 1.0), 1.0, 1}; }
};

template <>
struct StateMaker<slam::RenderedSubmap> {
  static slam::RenderedSubmap make() {
    return {{}, {slam::Keyframe{}}, {Pose2{}}, {.resolution_m = 1.0, .max_extent_m = 100.0}};
  }
};

template <>
struct StateMaker<slam::Particle> {
  static slam::Particle make() { return {.T_map_body = {}, .map = {1.0, 1.0}}; }
};

template <>
struct StateMaker<slam::TrajectoryNode> {
  static slam::TrajectoryNode make() { return {Pose2{}, nullptr}; }
};

}  // namespace patrol
