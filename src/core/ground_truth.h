#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/frames.h"
#include "core/time.h"

/// Ground truth from the simulator. Written to the log, never passed to the stack; only `score` and `render` read it.
/// tests/core/modules_test.py checks that no stack module includes this header.
namespace patrol {

struct GroundTruth {
  Time stamp{};
  Pose3 T_world_body;
  Twist3 twist;  ///< velocity in the body frame
};

/// Complete state of the physics model, in the order of MuJoCo. Sufficient to render the scene.
struct SimState {
  Time stamp{};
  std::vector<double> qpos;
  std::vector<double> mocap;  ///< [mocap body]: x y z qw qx qy qz
};

/// Values drawn for the simulated robot: calibration and manufacturing errors by name, "lidar.yaw_rad". Units are in
/// the names.
struct AsBuiltTruth {
  Time stamp{};
  std::vector<std::pair<std::string, double>> values;
};

/// Unintended contact of the robot. `first` is the geom of the robot, `second` the other geom.
struct Collision {
  Time stamp{};
  std::string first;
  std::string second;
};

}  // namespace patrol
