#include "navigation.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include <Eigen/Geometry>
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
constexpr Time kMaxStop = std::chrono::seconds(1);
constexpr double kBehind_m = 0.15, kBeside_m = 0.02;  // free ground behind and beside the footprint to back up
constexpr double kMinCarrot_m = 0.8;
constexpr Time kReplanPeriod = std::chrono::seconds(2);

}  // namespace

Navigation::Navigation(const std::vector<Eigen::Vector2d>& footprint_m, std::vector<Pose2> goals,
                       NavigationSettings settings, const std::filesystem::path& cache)
    : settings_(std::move(settings)),
      navigator_(std::make_unique<mrpt::nav::CReactiveNavigationSystem>(robot_, false)),
      footprint_m_(footprint_m),
      goals_(std::move(goals)) {
  navigator_->setMinLoggingLevel(mrpt::system::LVL_ERROR);
  mrpt::Clock::setActiveClock(mrpt::Clock::Source::Simulated);
  mrpt::Clock::setSimulatedTime(timestamp_of({}));
  mrpt::config::CConfigFileMemory config;
  navigator_->saveConfigFile(config);
  std::string text;
  config.getContent(text);
  config.setContent(text);  // what MRPT has saved is padded for people, and is read after parsing only
  configure(config, footprint_m, settings_);
  navigator_->loadConfigFile(config);
  navigator_->params_abstract_ptg_navigator.ptg_cache_files_directory = cache.string();
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

/// Point of the path that is about `carrot_m` ahead, or the last one before that with a clear line to it.
Pose2 Navigation::carrot() const {
  const auto distance_m = [&](const Pose2& pose) { return (pose.position() - robot_.T_map_body.position()).norm(); };
  const Pose2 T_body_map = robot_.T_map_body.inverse();
  auto target = std::ranges::min_element(path_, {}, distance_m);
  while (target + 1 != path_.end() && distance_m(*target) < settings_.carrot_m) {
    const bool is_near = distance_m(*(target + 1)) < kMinCarrot_m;
    if (!is_near && clearance_m(T_body_map * (target + 1)->position()) < settings_.carrot_clearance_m) break;
    ++target;
  }
  return *target;
}

double Navigation::clearance_m(const Eigen::Vector2d& p_body) const {
  double least_m = std::numeric_limits<double>::infinity();
  const double length_m = p_body.norm();
  const Eigen::Vector2d direction = length_m > 0.0 ? Eigen::Vector2d(p_body / length_m) : Eigen::Vector2d::UnitX();
  for (std::size_t i = 0; i < robot_.obstacles.size(); ++i) {
    float x = 0.0F, y = 0.0F;
    robot_.obstacles.getPoint(i, x, y);
    const Eigen::Vector2d obstacle(x, y);
    const double along_m = std::clamp(obstacle.dot(direction), 0.0, length_m);
    least_m = std::min(least_m, (obstacle - along_m * direction).norm());
  }
  return least_m;
}

bool Navigation::is_free_behind() const {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : footprint_m_) box.extend(corner);
  const Eigen::Vector2d low = box.min() - Eigen::Vector2d(kBehind_m, kBeside_m);
  const Eigen::Vector2d high(0.0, box.max().y() + kBeside_m);
  const Eigen::AlignedBox2d behind(low, high);
  for (std::size_t i = 0; i < robot_.obstacles.size(); ++i) {
    float x = 0.0F, y = 0.0F;
    robot_.obstacles.getPoint(i, x, y);
    if (behind.contains(Eigen::Vector2d(x, y))) return false;
  }
  return true;
}

bool Navigation::is_backing_up(const Odometry& odometry) {
  if (!backing_up_to_m_) return false;
  if (odometry.distance_m() < *backing_up_to_m_ && is_free_behind()) return true;
  backing_up_to_m_.reset();
  next_plan_ = robot_.now;
  return false;
}

void Navigation::note_stop(const Odometry& odometry) {
  const bool is_stopped = robot_.command_mps == 0.0 && robot_.command_radps == 0.0;
  if (!is_stopped || settings_.backing_up_m == 0.0) {
    stopped_since_.reset();
  } else if (!stopped_since_) {
    stopped_since_ = robot_.now;
  } else if (robot_.now - *stopped_since_ > kMaxStop) {
    backing_up_to_m_ = odometry.distance_m() + settings_.backing_up_m;
    stopped_since_.reset();
  }
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
  if (is_backing_up(odometry)) return {.stamp = now, .vx_mps = -kSlow_mps};
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
  is_turning_ = std::abs(bearing_rad) > (is_turning_ ? kAligned_rad : kBehind_rad) &&
                clearance_m(Eigen::Vector2d::Zero()) >= settings_.turning_radius_m;
  if (is_turning_) {
    return {.stamp = now, .vx_mps = 0.0, .vy_mps = 0.0, .yaw_rate_radps = std::copysign(kTurn_radps, bearing_rad)};
  }
  request(target);
  navigator_->navigationStep();
  note_stop(odometry);
  return {.stamp = now, .vx_mps = robot_.command_mps, .vy_mps = 0.0, .yaw_rate_radps = robot_.command_radps};
}

}  // namespace mrpt_stack
