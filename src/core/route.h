#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "core/named_table.h"
#include "core/tunnel_lining.h"
#include "core/uwb.h"

namespace patrol {

/// Task of the robot at a station of the route.
enum class StationType : std::uint8_t { kInspect, kPass, kHome };

inline constexpr std::array kStationTypes = std::to_array<NamedValue<StationType>>({
    {StationType::kInspect, "inspect", "Stop, point the instrument at the target and measure"},
    {StationType::kPass, "pass", "Walk past without a stop"},
    {StationType::kHome, "home", "Stop and end the mission"},
});
static_assert(is_in_order(kStationTypes));

constexpr std::string_view name_of(StationType type) { return row_of(kStationTypes, type).name; }

/// Task of the robot at a goal; the letters are those of nav.json ([Liu21, table 1]).
enum class GoalType : std::uint8_t { kStop, kVia, kScan, kOperator };

inline constexpr std::array kGoalTypes = std::to_array<NamedValue<GoalType>>({
    {GoalType::kStop, "N", "Stop there"},
    {GoalType::kVia, "V", "Pass without a stop"},
    {GoalType::kScan, "D", "Stop and scan the lining"},
    {GoalType::kOperator, "R", "Stop until an operator has driven the robot and handed over control again"},
});
static_assert(is_in_order(kGoalTypes));

constexpr std::string_view name_of(GoalType type) { return row_of(kGoalTypes, type).name; }

/// Station of the inspection route, in the frame of the route: `site` (the survey frame) or `map`. The surveyed start
/// pose of the robot in `site` relates the two frames (inspect/route_frame.h).
struct Station {
  int number = 0;
  std::string name;  ///< e.g. "regulator_box_2"
  StationType type = StationType::kInspect;
  Pose2 T_route_body;                                        ///< pose of the robot at the station
  Eigen::Vector3d p_route_target = Eigen::Vector3d::Zero();  ///< target point of the instrument, m
  double accuracy_m = 0.2;                                   ///< position tolerance at the station
  int priority = 0;         ///< lower values are visited first if the robot orders the stations itself
  double earliest_s = 0.0;  ///< start of the time window since mission start: no work before it
  /// End of the time window since mission start; a soft limit.
  double latest_s = std::numeric_limits<double>::infinity();
};

/// Charging post: pose of the docked robot and outline of the post at lidar height.
struct Dock {
  Pose2 T_route_docked;
  std::vector<Eigen::Vector2d> profile_m;  ///< polyline in the frame of the docked body
};

/// Stations in their order, and keep-out lines that the robot must not cross. Keep-out lines are surveyed full-height
/// curbs, which the 2D lidar cannot detect.
struct Route {
  std::vector<Station> stations = {};
  std::vector<std::vector<Eigen::Vector2d>> keep_out_lines = {};  ///< polylines in the frame of the route, m
  std::vector<UwbAnchor> anchors = {};                            ///< positions in the frame of the route
  std::optional<Dock> dock = {};
  std::optional<TunnelLining> lining = {};

  std::vector<std::string> station_names() const {
    std::vector<std::string> names;
    for (const Station& station : stations) names.push_back(station.name);
    return names;
  }
};

/// Goal pose in `map`, saved while a person drove the robot there: an entry of nav.json [Liu21, table 1].
struct SavedGoal {
  int number = 0;
  Pose2 T_map_body;
  GoalType type = GoalType::kStop;
  double accuracy_m = 0.1;  ///< position tolerance

  /// Returns the name in events, metrics and results, e.g. "goal_2".
  std::string name() const { return "goal_" + std::to_string(number); }
};

}  // namespace patrol
