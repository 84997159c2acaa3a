#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

/// Task of the robot at a goal; the letters are those of nav.json (paper 004, table 1).
enum class GoalType : std::uint8_t { kStop, kVia, kScan, kOperator };

inline constexpr std::array kGoalTypes = std::to_array<NamedValue<GoalType>>({
    {GoalType::kStop, "N", "Stop there"},
    {GoalType::kVia, "V", "Pass without a stop"},
    {GoalType::kScan, "D", "Stop and scan the lining"},
    {GoalType::kOperator, "R", "Stop until an operator has driven the robot and handed over control again"},
});
static_assert(is_in_order(kGoalTypes));

constexpr std::string_view name_of(GoalType type) { return row_of(kGoalTypes, type).name; }

/// A place of the inspection route, in the route's frame: `site`, the frame of the survey, or `map`. The robot's start pose in
/// `site` is surveyed too, and joins the two (inspect/route_frame.h).
struct Station {
  int number = 0;
  std::string name;  ///< e.g. "regulator_box_2"
  StationType type = StationType::kInspect;
  Pose2 T_route_body;  ///< where the robot shall stand
  Eigen::Vector3d p_route_target = Eigen::Vector3d::Zero();  ///< what the instrument looks at, m
  double accuracy_m = 0.2;  ///< how near the standing place counts as reached
  int priority = 0;         ///< lower ones come first, where the robot orders its stations itself
  double earliest_s = 0.0;  ///< of the mission: work there does not begin before, and
  double latest_s = std::numeric_limits<double>::infinity();  ///< if it can be helped, not after
};

/// The post at which the robot charges: where its body is when it is docked, and the post's outline at the lidar's height.
struct Dock {
  Pose2 T_route_docked;
  std::vector<Eigen::Vector2d> profile_m;  ///< polyline in the docked body's frame
};

/// The order of stations, and lines that the robot must not walk across (full-height kerbs, which its 2D lidar cannot
/// see but the survey knows).
struct Route {
  std::vector<Station> stations = {};
  std::vector<std::vector<Eigen::Vector2d>> keep_out_lines = {};  ///< polylines in the route's frame, m
  std::vector<UwbAnchor> anchors = {};                            ///< in the route's frame
  std::optional<Dock> dock = {};
  std::optional<TunnelLining> lining = {};
};

/// A place to drive to, marked in `map` by driving there: an entry of nav.json (paper 004, table 1).
struct MarkedGoal {
  int number = 0;
  Pose2 T_map_body;
  GoalType type = GoalType::kStop;
  double accuracy_m = 0.1;  ///< how near counts as reached
};

}  // namespace patrol
