#pragma once

#include "core/state/message_state.h"
#include "localize/inertial_filter.h"
#include "localize/track_encoders.h"
#include "localize/track_filter.h"
#include "slam/state/slam_state.h"

namespace patrol {

template <>
struct StateMaker<localize::InertialFilter> {
  static localize::InertialFilter make() { return {{}, {.force_mps2 = Eigen::Vector3d::UnitZ()}}; }
};

template <>
struct StateMaker<localize::TrackFilter> {
  static localize::TrackFilter make() { return {{}, {.force_mps2 = Eigen::Vector3d::UnitZ()}}; }
};

template <>
struct StateMaker<localize::DriveTicks> {
  static localize::DriveTicks make() { return TrackTicks{}; }
};

}  // namespace patrol
