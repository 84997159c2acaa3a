#include "mrpt_stack.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <filesystem>
#include <map>
#include <numbers>

#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/core/Clock.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/nav/planners/PlannerSimple2D.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/random/RandomGenerators.h>

#include "core/geometry/angles.h"

namespace mrpt_stack {
namespace {

using mrpt::maps::COccupancyGridMap2D;

constexpr std::size_t kParticles = 600;
constexpr double kMinTravel_m = 0.1, kMinTurn_rad = 0.05;  ///< between two updates by a scan
constexpr double kSpeed_mps = 0.6, kYawRate_radps = 0.6;
constexpr double kObstacleRange_m = 8.0;
constexpr double kGoalTolerance_m = 0.3, kCarrot_m = 3.0;
constexpr double kUndocking_m = 1.5, kSlow_mps = 0.25;   ///< backward from the charging post
constexpr double kBehind_rad = 1.2, kAligned_rad = 0.2;  ///< bearing at which a turn on the spot begins and ends
constexpr double kDepthRange_m = 2.5, kMinHeight_m = 0.06, kMaxHeight_m = 0.5;
constexpr double kCell_m = 0.05;
constexpr Time kMemory = std::chrono::seconds(12);
constexpr int kMinPoints = 2;  ///< of an image in a cell
constexpr Time kReplanPeriod = std::chrono::seconds(2);

mrpt::poses::CPose2D to_mrpt(const Pose2& pose) { return {pose.x, pose.y, pose.yaw}; }
mrpt::math::TPose2D to_plain(const Pose2& pose) { return {pose.x, pose.y, pose.yaw}; }

/// Simulated time as MRPT's.
mrpt::system::TTimeStamp timestamp_of(Time time) { return mrpt::Clock::fromDouble(1.0 + patrol::to_seconds(time)); }

COccupancyGridMap2D::Ptr grid_of(const patrol::OccupancyGrid& map) {
  const patrol::GridGeometry& geometry = map.geometry();
  auto grid = COccupancyGridMap2D::Create();
  const auto resolution = static_cast<float>(geometry.resolution_m);
  const auto x = static_cast<float>(geometry.origin_m.x()), y = static_cast<float>(geometry.origin_m.y());
  grid->setSize(x, x + static_cast<float>(geometry.width) * resolution, y,
                y + static_cast<float>(geometry.height) * resolution, resolution);
  for (int row = 0; row < geometry.height; ++row) {
    for (int col = 0; col < geometry.width; ++col) {
      const int value = map.values()[static_cast<std::size_t>(row * geometry.width + col)];
      grid->setCell(col, row, value < 0 ? 0.5F : 1.0F - 0.01F * static_cast<float>(value));
    }
  }
  grid->likelihoodOptions.likelihoodMethod = COccupancyGridMap2D::lmLikelihoodField_Thrun;
  grid->likelihoodOptions.LF_stdHit = 0.15F;
  grid->likelihoodOptions.LF_zHit = 0.9F;
  grid->likelihoodOptions.LF_zRandom = 0.1F;
  grid->likelihoodOptions.LF_maxRange = 30.0F;
  grid->likelihoodOptions.LF_decimation = 8;
  grid->likelihoodOptions.LF_maxCorrsDistance = 0.5F;
  grid->likelihoodOptions.LF_alternateAverageMethod = false;
  return grid;
}

/// Every parameter that differs from MRPT's defaults.
void configure(mrpt::config::CConfigFileMemory& config, const std::vector<Eigen::Vector2d>& footprint_m) {
  const std::string abstract = "CAbstractPTGBasedReactive", reactive = "CReactiveNavigationSystem";
  config.write("CAbstractNavigator", "alarm_seems_not_approaching_target_timeout", 60.0);
  config.write("CAbstractNavigator", "dist_check_target_is_blocked", 0.0);
  config.write(abstract, "robotMax_V_mps", kSpeed_mps);
  config.write(abstract, "robotMax_W_degps", patrol::to_deg(kYawRate_radps));
  config.write(abstract, "holonomic_method", "mrpt::nav::CHolonomicFullEval");
  config.write(abstract, "motion_decider_method", "mrpt::nav::CMultiObjMotionOpt_Scalarization");
  config.write(abstract, "ref_distance", 5.0);
  config.write(abstract, "secure_distance_start", 0.05);
  config.write(abstract, "secure_distance_end", 0.2);
  config.write(abstract, "use_delays_model", false);
  config.write(abstract, "enable_obstacle_filtering", false);
  // Scores of a candidate; an empty name ends the list.
  const std::string optimizer = "CMultiObjectiveMotionOptimizerBase";
  const std::pair<const char*, const char*> scores[] = {
      {"free_distance", "collision_free_distance"},
      {"nearness", "(ref_dist - dist_eucl_final) / ref_dist"},
      {"same_as_before", "hysteresis"},
      {"toward_target",
       "var d := abs(target_k - move_k); if (d > num_paths / 2) { d := num_paths - d; }; exp(-d / (0.1 * num_paths))"},
      {"", ""}};
  for (std::size_t i = 0; i < std::size(scores); ++i) {
    const std::string prefix = "score" + std::to_string(i + 1);
    config.write(optimizer, prefix + "_name", std::string(scores[i].first));
    config.write(optimizer, prefix + "_formula", std::string(scores[i].second));
  }
  config.write(optimizer, "scores_to_normalize", std::string());
  config.write("CMultiObjMotionOpt_Scalarization", "scalar_score_formula",
               "free_distance + nearness + 0.3 * same_as_before + toward_target");
  config.write(reactive, "min_obstacles_height", -1.0);
  config.write(reactive, "max_obstacles_height", 2.0);
  std::string xs, ys;
  for (const Eigen::Vector2d& corner : footprint_m) {
    const Eigen::Vector2d outer = corner + 0.08 * corner.normalized();  // margin
    xs += " " + std::to_string(outer.x());
    ys += " " + std::to_string(outer.y());
  }
  config.write(reactive, "RobotModel_shape2D_xs", xs);
  config.write(reactive, "RobotModel_shape2D_ys", ys);
  config.write(reactive, "RobotModel_circular_shape_radius", 0.62);
  config.write(reactive, "PTG_COUNT", 2);
  // Circular arcs forward, and turns toward a heading.
  const char* const types[] = {"CPTG_DiffDrive_C", "CPTG_DiffDrive_alpha"};
  for (int i = 0; i < 2; ++i) {
    const std::string prefix = "PTG" + std::to_string(i) + "_";
    config.write(reactive, prefix + "Type", types[i]);
    config.write(reactive, prefix + "resolution", 0.05);
    config.write(reactive, prefix + "refDistance", 5.0);
    config.write(reactive, prefix + "num_paths", 121);
    config.write(reactive, prefix + "v_max_mps", kSpeed_mps);
    config.write(reactive, prefix + "w_max_dps", patrol::to_deg(kYawRate_radps));
    config.write(reactive, prefix + "K", 1.0);
    config.write(reactive, prefix + "cte_a0v_deg", 57.0);
    config.write(reactive, prefix + "cte_a0w_deg", 57.0);
    config.write(reactive, prefix + "score_priority", 1.0);
  }
}

}  // namespace

void TrackOdometry::add(const patrol::TrackTicks& ticks) {
  if (last_ticks_ && ticks.stamp > last_ticks_->stamp) {
    const double counts =
        0.5 * static_cast<double>((ticks.left - last_ticks_->left) + (ticks.right - last_ticks_->right));
    const double distance_m = meters_per_tick_ * counts;
    const double dt_s = patrol::to_seconds(ticks.stamp - last_ticks_->stamp);
    T_odom_body_.x += distance_m * std::cos(T_odom_body_.yaw);
    T_odom_body_.y += distance_m * std::sin(T_odom_body_.yaw);
    speed_mps_ = distance_m / dt_s;
    if (ticks.left != last_ticks_->left || ticks.right != last_ticks_->right) num_at_rest_ = 0;
  }
  last_ticks_ = ticks;
}

void TrackOdometry::add(const patrol::Imu& imu) {
  constexpr double kWindow = 400.0;  // readings, 2 s and more
  const double rate_radps = imu.angular_velocity_radps.z();
  // The bias is the mean while the tracks stand still, and not just after they stopped.
  if (speed_mps_ == 0.0 && ++num_at_rest_ > 100) {
    const double count = std::min(static_cast<double>(num_at_rest_ - 100), kWindow);
    gyro_bias_radps_ += (rate_radps - gyro_bias_radps_) / count;
  }
  yaw_rate_radps_ = rate_radps - gyro_bias_radps_;
  if (last_imu_) T_odom_body_.yaw += yaw_rate_radps_ * patrol::to_seconds(imu.stamp - *last_imu_);
  last_imu_ = imu.stamp;
}

mrpt::obs::CObservation2DRangeScan to_mrpt(const patrol::LaserScan& scan, const patrol::Pose3& T_body_lidar) {
  mrpt::obs::CObservation2DRangeScan converted;
  const std::size_t num_beams = scan.ranges_m.size();
  converted.timestamp = timestamp_of(scan.stamp);
  converted.aperture = static_cast<float>(scan.angle_increment_rad * static_cast<double>(num_beams - 1));
  converted.rightToLeft = true;
  converted.maxRange = static_cast<float>(scan.range_max_m);
  converted.resizeScan(num_beams);
  for (std::size_t i = 0; i < num_beams; ++i) {
    const float range_m = scan.ranges_m[i];
    const bool is_valid = std::isfinite(range_m) && range_m > scan.range_min_m && range_m < scan.range_max_m;
    converted.setScanRange(i, is_valid ? range_m : converted.maxRange);
    converted.setScanRangeValidity(i, is_valid);
  }
  // MRPT's scan is symmetric about the sensor's x axis.
  const double middle_rad = scan.angle_min_rad + 0.5 * static_cast<double>(converted.aperture);
  const Eigen::Vector3d& p = T_body_lidar.position;
  converted.sensorPose = {p.x(), p.y(), p.z(), patrol::to_yaw(T_body_lidar.rotation) + middle_rad, 0.0, 0.0};
  return converted;
}

Localization::Localization(const patrol::OccupancyGrid& map, const Pose2& T_map_start,
                           const patrol::Pose3& T_body_lidar, std::uint64_t seed)
    : map_(grid_of(map)), filter_(kParticles), T_body_lidar_(T_body_lidar), T_map_odom_(T_map_start) {
  mrpt::random::getRandomGenerator().randomize(static_cast<std::uint32_t>(seed));
  filter_.options.metricMap = map_;
  mrpt::random::CRandomGenerator& draw = mrpt::random::getRandomGenerator();
  filter_.resetDeterministic(to_plain(T_map_start), kParticles);
  for (auto& particle : filter_.m_particles) {
    particle.d.x += draw.drawGaussian1D(0.0, 0.1);
    particle.d.y += draw.drawGaussian1D(0.0, 0.1);
    particle.d.phi += draw.drawGaussian1D(0.0, 0.02);
  }
}

void Localization::update(const patrol::LaserScan& scan, const Pose2& T_odom_body) {
  const Pose2 moved = last_T_odom_body_.inverse() * T_odom_body;
  if (moved.position().norm() < kMinTravel_m && std::abs(patrol::wrap_angle(moved.yaw)) < kMinTurn_rad) return;
  last_T_odom_body_ = T_odom_body;
  mrpt::obs::CActionRobotMovement2D::TMotionModelOptions motion;
  motion.modelSelection = mrpt::obs::CActionRobotMovement2D::mmGaussian;
  motion.gaussianModel.a1 = 0.03F;
  motion.gaussianModel.minStdXY = 0.003F;
  motion.gaussianModel.minStdPHI = 0.003F;
  mrpt::obs::CActionRobotMovement2D movement;
  movement.computeFromOdometry(to_mrpt(moved), motion);
  mrpt::obs::CActionCollection actions;
  actions.insert(movement);
  mrpt::obs::CSensoryFrame frame;
  frame.insert(mrpt::obs::CObservation2DRangeScan::Create(mrpt_stack::to_mrpt(scan, T_body_lidar_)));
  mrpt::bayes::CParticleFilter filter;
  filter.m_options.PF_algorithm = mrpt::bayes::CParticleFilter::pfStandardProposal;
  filter.m_options.adaptiveSampleSize = false;
  filter.m_options.resamplingMethod = mrpt::bayes::CParticleFilter::prSystematic;
  filter.executeOn(filter_, &actions, &frame);

  mrpt::poses::CPosePDFGaussian estimate;
  estimate.copyFrom(filter_);
  const mrpt::poses::CPose2D& mean = estimate.mean;
  T_map_odom_ = Pose2{mean.x(), mean.y(), mean.phi()} * T_odom_body.inverse();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) covariance_(i, j) = estimate.cov(i, j);
  }
}

void LowObstacles::add(const patrol::DepthImage& image, const Pose2& T_odom_body) {
  std::map<std::pair<int, int>, int> counts;
  for (int row = 0; row < image.height; ++row) {
    for (int col = 0; col < image.width; ++col) {
      const double depth_m = 1e-3 * image.depth_mm[static_cast<std::size_t>(row * image.width + col)];
      if (depth_m <= 0.0 || depth_m > kDepthRange_m) continue;
      const Eigen::Vector3d p_camera{depth_m, (image.cx_px - col) * depth_m / image.fx_px,
                                     (image.cy_px - row) * depth_m / image.fy_px};
      const Eigen::Vector3d p_body = T_body_camera_ * p_camera;
      const double height_m = p_body.z() - ground_m_;
      if (height_m < kMinHeight_m || height_m > kMaxHeight_m) continue;
      const Eigen::Vector2d p_odom = T_odom_body * Eigen::Vector2d(p_body.head<2>());
      ++counts[{static_cast<int>(std::floor(p_odom.x() / kCell_m)),
                static_cast<int>(std::floor(p_odom.y() / kCell_m))}];
    }
  }
  for (const auto& [cell, count] : counts) {
    if (count >= kMinPoints) last_seen_[cell] = image.stamp;
  }
}

void LowObstacles::append_to(mrpt::maps::CSimplePointsMap& points, Time now, const Pose2& T_odom_body) {
  const Pose2 T_body_odom = T_odom_body.inverse();
  std::erase_if(last_seen_, [&](const auto& entry) {
    const auto& [cell, seen] = entry;
    const Eigen::Vector2d p_body =
        T_body_odom * Eigen::Vector2d((cell.first + 0.5) * kCell_m, (cell.second + 0.5) * kCell_m);
    if (now - seen > kMemory) return true;  // a person has gone on
    points.insertPoint(static_cast<float>(p_body.x()), static_cast<float>(p_body.y()), 0.0F);
    return false;
  });
}

bool RobotInterface::getCurrentPoseAndSpeeds(mrpt::math::TPose2D& pose, mrpt::math::TTwist2D& velocity,
                                             mrpt::system::TTimeStamp& timestamp, mrpt::math::TPose2D& odometry,
                                             std::string& frame) {
  pose = to_plain(T_map_body);
  velocity = {speed_mps * std::cos(T_map_body.yaw), speed_mps * std::sin(T_map_body.yaw), yaw_rate_radps};
  timestamp = timestamp_of(now);
  odometry = to_plain(T_odom_body);
  frame = "map";
  return true;
}

bool RobotInterface::changeSpeeds(const mrpt::kinematics::CVehicleVelCmd& command) {
  const auto& differential = dynamic_cast<const mrpt::kinematics::CVehicleVelCmd_DiffDriven&>(command);
  command_mps = differential.lin_vel;
  command_radps = differential.ang_vel;
  return true;
}

bool RobotInterface::stop(bool) {
  command_mps = command_radps = 0.0;
  return true;
}

mrpt::kinematics::CVehicleVelCmd::Ptr RobotInterface::getStopCmd() {
  auto command = std::make_shared<mrpt::kinematics::CVehicleVelCmd_DiffDriven>();
  command->setToStop();
  return command;
}

bool RobotInterface::senseObstacles(mrpt::maps::CSimplePointsMap& points, mrpt::system::TTimeStamp& timestamp) {
  points = obstacles;
  timestamp = timestamp_of(now);
  return true;
}

Navigation::Navigation(const std::vector<Eigen::Vector2d>& footprint_m, std::vector<Pose2> goals)
    : navigator_(std::make_unique<mrpt::nav::CReactiveNavigationSystem>(robot_, false)), goals_(std::move(goals)) {
  mrpt::Clock::setActiveClock(mrpt::Clock::Source::Simulated);
  mrpt::Clock::setSimulatedTime(timestamp_of({}));
  mrpt::config::CConfigFileMemory config;
  navigator_->saveConfigFile(config);
  std::string text;
  config.getContent(text);
  config.setContent(text);  // what MRPT has saved is padded for people, and is read after parsing only
  configure(config, footprint_m);
  navigator_->loadConfigFile(config);
  navigator_->params_abstract_ptg_navigator.ptg_cache_files_directory = std::filesystem::temp_directory_path().string();
  navigator_->initialize();
}

void Navigation::plan(const COccupancyGridMap2D& map, const Pose2& T_map_body) {
  mrpt::nav::PlannerSimple2D planner;
  planner.robotRadius = 0.65F;
  planner.minStepInReturnedPath = 0.3F;
  std::deque<mrpt::math::TPoint2D> points;
  bool is_not_found = false;
  planner.computePath(map, to_mrpt(T_map_body), to_mrpt(goals_[next_goal_]), points, is_not_found);
  path_.clear();
  if (!is_not_found) {
    for (const mrpt::math::TPoint2D& point : points) path_.push_back({point.x, point.y, 0.0});
  }
  path_.push_back(goals_[next_goal_]);
}

/// Point of the path that is about kCarrot_m ahead.
Pose2 Navigation::carrot() const {
  const auto distance_m = [&](const Pose2& pose) { return (pose.position() - robot_.T_map_body.position()).norm(); };
  auto target = std::ranges::min_element(path_, {}, distance_m);
  while (target + 1 != path_.end() && distance_m(*target) < kCarrot_m) ++target;
  return *target;
}

void Navigation::request(const Pose2& target) {
  const bool is_goal = target.position() == path_.back().position();
  mrpt::nav::CAbstractPTGBasedReactive::TNavigationParamsPTG request;
  request.target.target_coords = to_plain(target);
  request.target.targetAllowedDistance = static_cast<float>(is_goal ? kGoalTolerance_m : 0.5);
  request.target.targetIsIntermediaryWaypoint = !is_goal;
  navigator_->navigate(&request);
}

patrol::VelocityCommand Navigation::step(Time now, const Localization& localization, const TrackOdometry& odometry,
                                         const std::optional<patrol::LaserScan>& scan,
                                         const patrol::Pose3& T_body_lidar, LowObstacles& low_obstacles) {
  mrpt::Clock::setSimulatedTime(timestamp_of(now));
  robot_.now = now;
  robot_.T_odom_body = odometry.pose();
  robot_.T_map_body = localization.pose_at(odometry.pose());
  robot_.speed_mps = odometry.speed_mps();
  robot_.yaw_rate_radps = odometry.yaw_rate_radps();
  if (scan) {
    robot_.obstacles.clear();
    const mrpt::obs::CObservation2DRangeScan converted = mrpt_stack::to_mrpt(*scan, T_body_lidar);
    robot_.obstacles.loadFromRangeScan(converted);
    low_obstacles.append_to(robot_.obstacles, now, odometry.pose());
  }
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
    plan(localization.map(), robot_.T_map_body);
  }
  if ((odometry.pose().position()).norm() < kUndocking_m && !has_left_) return {.stamp = now, .vx_mps = -kSlow_mps};
  has_left_ = true;
  const Pose2 target = carrot();
  const Eigen::Vector2d ahead = (robot_.T_map_body.inverse() * target).position();
  const double bearing_rad = std::atan2(ahead.y(), ahead.x());
  is_turning_ = std::abs(bearing_rad) > (is_turning_ ? kAligned_rad : kBehind_rad);
  if (is_turning_)
    return {.stamp = now, .vx_mps = 0.0, .vy_mps = 0.0, .yaw_rate_radps = std::copysign(0.4, bearing_rad)};
  request(target);
  navigator_->navigationStep();
  return {.stamp = now, .vx_mps = robot_.command_mps, .vy_mps = 0.0, .yaw_rate_radps = robot_.command_radps};
}

}  // namespace mrpt_stack
