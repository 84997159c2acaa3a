#pragma once

#include <string>
#include <vector>

#include "core/frames.h"
#include "core/time.h"

/// What only the twin knows. It goes round the stack, straight to the log, and only `score` and `render` read it; a test
/// (tests/core/rooms_test.py) holds that no room of the stack includes this file.
namespace patrol {

struct GroundTruth {
  Time stamp{};
  Pose3 T_world_body;
  Twist3 twist;  ///< in body
};

/// Everything needed to draw the scene again, in the physics model's own order.
struct SimState {
  Time stamp{};
  std::vector<double> qpos;
  std::vector<double> mocap;  ///< per mocap body: x y z qw qx qy qz
};

/// The robot touched what it should not have (`first` is the robot's geom, `second` the other).
struct Collision {
  Time stamp{};
  std::string first;
  std::string second;
};

}  // namespace patrol
