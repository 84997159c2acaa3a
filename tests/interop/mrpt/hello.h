#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/frames.h"
#include "core/grid.h"
#include "core/robot_description.h"
#include "link/stack_client.h"
#include "navigation_settings.h"

namespace mrpt_stack {

using patrol::Pose2;

/// Content of the simulator's hello that the stack uses.
struct Task {
  patrol::RobotDescription robot = {};
  double ticks_per_turn = 0.0;  ///< counts of a track encoder per turn of the sprocket
  std::optional<patrol::OccupancyGrid> map =
      std::nullopt;                        ///< none: the robot makes its own from the surveyed start, its origin
  Pose2 T_map_start = {};                  ///< surveyed start
  std::vector<Pose2> goals = {};           ///< in map: saved goals, else the stations of the mission
  std::vector<std::string> stations = {};  ///< names of the goals that are stations
  NavigationSettings navigation = {};
  std::uint64_t seed = 0;
};

/// Reads the hello and its documents. Throws std::runtime_error if the robot has neither tracks nor wheels that are not
/// steered, or if there are no goals.
Task task_of(const patrol::link::StackClient& client);

}  // namespace mrpt_stack
