#pragma once

#include <mrpt/core/Clock.h>
#include <mrpt/math/TPose2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/poses/CPose2D.h>

#include "core/frames.h"
#include "core/sensors/registry.h"

namespace mrpt_stack {

using patrol::Pose2;
using patrol::Time;

inline mrpt::poses::CPose2D to_mrpt(const Pose2& pose) { return {pose.x, pose.y, pose.yaw}; }
inline mrpt::math::TPose2D to_plain(const Pose2& pose) { return {pose.x, pose.y, pose.yaw}; }

/// Converts simulated time to MRPT's.
inline mrpt::system::TTimeStamp timestamp_of(Time time) {
  return mrpt::Clock::fromDouble(1.0 + patrol::to_seconds(time));
}

/// Returns whether a beam has a return.
bool is_return(const patrol::LaserScan& scan, float range_m);

/// Converts a scan to MRPT's. `T_body_lidar`: mount of the lidar.
mrpt::obs::CObservation2DRangeScan to_mrpt(const patrol::LaserScan& scan, const patrol::Pose3& T_body_lidar);

}  // namespace mrpt_stack
