#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "core/grid.h"
#include "core/messages.h"

namespace patrol::app {

/// What there is to see of a run that goes on; poses in map.
struct WatchedRun {
  std::string name;
  Time now{};
  double distance_m = 0.0;
  double real_time_factor = 0.0;
  OccupancyGrid map;
  std::optional<PoseEstimate> estimate;
  std::optional<Pose2> truth;
  std::vector<Pose2> path;              ///< that the robot means to drive
  std::vector<Eigen::Vector2d> driven_m;  ///< by its own estimate
  std::optional<LocalizationTrust> trust;
  VelocityCommand command;
  std::deque<Event> events;             ///< the newest last
};

/// The run as a page of a terminal, `columns` x `rows` characters, with ANSI colours: figures, the map about the robot (north of map up, two
/// by four dots in a character), the newest events. Lines end in "\033[K\r\n", so that a frame covers the one before.
std::string watch_frame(const WatchedRun& run, int columns, int rows);

}  // namespace patrol::app
