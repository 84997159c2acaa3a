#pragma once

#include "core/messages.h"
#include "core/sensors/registry.h"
#include "core/state/state_archive.h"

namespace patrol {

template <>
struct StateBase<RearLaserScan> {
  using type = LaserScan;
};
template <>
struct StateBase<UwbPoseEstimate> {
  using type = PoseEstimate;
};

}  // namespace patrol
