#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "core/grid.h"
#include "core/messages.h"

namespace patrol::app {

/// State of a running simulation for display; poses in map.
struct RunView {
  std::string name;
  Time now{};
  double distance_m = 0.0;
  double real_time_factor = 0.0;
  OccupancyGrid map;
  std::optional<PoseEstimate> estimate;
  std::optional<Pose2> truth;
  std::vector<Pose2> path;                  ///< planned path
  std::vector<Eigen::Vector2d> traveled_m;  ///< trajectory, by the robot's own estimate
  std::optional<LocalizationConfidence> confidence;
  VelocityCommand command;
  std::deque<Event> events;  ///< newest last
};

/// Renders the state for a terminal, `columns` x `rows` characters, with ANSI colors: values, the map around the robot,
/// the newest events. The map has north up and 2 x 4 dots per character. Lines end in "\033[K\r\n", so that a frame
/// overwrites the previous one.
std::string render_run_view(const RunView& run, int columns, int rows);

}  // namespace patrol::app
