#include "navigation.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <filesystem>

#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/core/Clock.h>
#include <mrpt/nav/planners/PlannerSimple2D.h>

#include "conversions.h"
#include "navigator_config.h"

namespace mrpt_stack {
namespace {

using mrpt::maps::COccupancyGridMap2D;

constexpr double kGoalTolerance_m = 0.3;
constexpr double kSlow_mps = 0.25;                       ///< backward from the charging post
constexpr double kBehind_rad = 1.2, kAligned_rad = 0.2;  ///< bearing at which a turn on the spot begins and ends
constexpr double kTurn_radps = 0.4;
constexpr Time kReplanPeriod = std::chrono::seconds(2);

}  // namespace

Navigation::Navigation(const std::vector<Eigen::Vector2d>& footprint_m, std::vector<Pose2> goals,
                       NavigationSettings settings)
    : settings_(std::move(settings)),
      navigator_(std::make_unique<mrpt::nav::CReactiveNavigationSystem>(robot_, false)),
      goals_(std::move(goals)) {
  mrpt::Clock::setActiveClock(mrpt::Clock::Source::Simulated);
  mrpt::Clock::setSimulatedTime(timestamp_of({}));
  mrpt::config::CConfigFileMemory config;
  navigator_->saveConfigFile(config);
  std::string text;
  config.getContent(text);
  config.setContent(text);  // what MRPT has saved is padded for people, and is read after parsing only
  configure(config, footprint_m, settings_);
  navigator_->loadConfigFile(config);
  navigator_->params_abstract_ptg_navigator.ptg_cache_files_directory = std::filesystem::temp_directory_path().string();
  navigator_->initialize();
}

void Navigation::plan(const COccupancyGridMap2D& grid, const Pose2& T_map_body) {
  mrpt::nav::PlannerSimple2D planner;
  planner.occupancyThreshold = static_cast<float>(1.0 - settings_.min_occupancy);
  planner.minStepInReturnedPath = 0.3F;
  std::deque<mrpt::math::TPoint2D> points;
  bool is_not_found = true;
  for (const double radius_m : settings_.planner_radii_m) {
    planner.robotRadius = static_cast<float>(radius_m);
    planner.computePath(grid, to_mrpt(T_map_body), to_mrpt(goals_[next_goal_]), points, is_not_found);
    if (!is_not_found) break;
  }
  path_.clear();
  if (!is_not_found) {
    for (const mrpt::math::TPoint2D& point : points) path_.push_back({point.x, point.y, 0.0});
  }
  path_.push_back(goals_[next_goal_]);
}

/// Point of the path that is about `carrot_m` ahead.
Pose2 Navigation::carrot() const {
  const auto distance_m = [&](const Pose2& pose) { return (pose.position() - robot_.T_map_body.position()).norm(); };
  auto target = std::ranges::min_element(path_, {}, distance_m);
  while (target + 1 != path_.end() && distance_m(*target) < settings_.carrot_m) ++target;
  return *target;
}

bool Navigation::can_turn() const {
  const auto radius_m = static_cast<float>(settings_.turning_radius_m);
  for (std::size_t i = 0; i < robot_.obstacles.size(); ++i) {
    float x = 0.0F, y = 0.0F;
    robot_.obstacles.getPoint(i, x, y);
    if (std::hypot(x, y) < radius_m) return false;
  }
  return true;
}

void Navigation::request(const Pose2& target) {
  const bool is_goal = target.position() == path_.back().position();
  mrpt::nav::CAbstractPTGBasedReactive::TNavigationParamsPTG request;
  request.target.target_coords = to_plain(target);
  request.target.targetAllowedDistance = static_cast<float>(is_goal ? kGoalTolerance_m : 0.5);
  request.target.targetIsIntermediaryWaypoint = !is_goal;
  navigator_->navigate(&request);
}

patrol::VelocityCommand Navigation::step(Time now, const Positioning& positioning, const Odometry& odometry) {
  mrpt::Clock::setSimulatedTime(timestamp_of(now));
  robot_.now = now;
  robot_.T_odom_body = odometry.pose();
  robot_.T_map_body = positioning.pose_at(odometry.pose());
  robot_.speed_mps = odometry.speed_mps();
  robot_.yaw_rate_radps = odometry.yaw_rate_radps();
  if (is_over()) return {.stamp = now};
  const bool is_at_goal = (robot_.T_map_body.position() - goals_[next_goal_].position()).norm() < kGoalTolerance_m;
  if (is_at_goal) {
    ++next_goal_;
    next_plan_ = now;
    navigator_->cancel();
    if (is_over()) return {.stamp = now};
  }
  if (now >= next_plan_) {
    next_plan_ = now + kReplanPeriod;
    plan(positioning.grid(), robot_.T_map_body);
  }
  if (odometry.pose().position().norm() < settings_.undocking_m && !has_left_) {
    return {.stamp = now, .vx_mps = -kSlow_mps};
  }
  has_left_ = true;
  const Pose2 target = carrot();
  const Eigen::Vector2d ahead = (robot_.T_map_body.inverse() * target).position();
  const double bearing_rad = std::atan2(ahead.y(), ahead.x());
  is_turning_ = std::abs(bearing_rad) > (is_turning_ ? kAligned_rad : kBehind_rad) && can_turn();
  if (is_turning_) {
    return {.stamp = now, .vx_mps = 0.0, .vy_mps = 0.0, .yaw_rate_radps = std::copysign(kTurn_radps, bearing_rad)};
  }
  request(target);
  navigator_->navigationStep();
  return {.stamp = now, .vx_mps = robot_.command_mps, .vy_mps = 0.0, .yaw_rate_radps = robot_.command_radps};
}

}  // namespace mrpt_stack
