#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <mrpt/kinematics/CVehicleVelCmd_DiffDriven.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/nav/reactive/CReactiveNavigationSystem.h>
#include <mrpt/nav/reactive/CRobot2NavInterface.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/slam/CMonteCarloLocalization2D.h>

#include "core/frames.h"
#include "core/grid.h"
#include "core/messages.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"

/// Software of a tracked robot made of the parts of MRPT (mrpt.org): particle filter localization on a known map,
/// planner on the map, and reactive navigator with PTGs. It knows what `patrol run --stack` sends, and nothing else of
/// Patrol.
namespace mrpt_stack {

using patrol::Pose2;
using patrol::Time;

/// Odometry by track counters and gyro.
class TrackOdometry {
 public:
  explicit TrackOdometry(double meters_per_tick) : meters_per_tick_(meters_per_tick) {}

  void add(const patrol::TrackTicks& ticks);
  void add(const patrol::Imu& imu);

  const Pose2& pose() const { return T_odom_body_; }
  double speed_mps() const { return speed_mps_; }
  double yaw_rate_radps() const { return yaw_rate_radps_; }

 private:
  double meters_per_tick_;
  std::optional<patrol::TrackTicks> last_ticks_;
  std::optional<Time> last_imu_;
  Pose2 T_odom_body_;
  double speed_mps_ = 0.0;
  double yaw_rate_radps_ = 0.0;
  double gyro_bias_radps_ = 0.0;
  int num_at_rest_ = 0;  ///< number of gyro readings since the robot stands
};

/// Monte Carlo localization on a known map.
class Localization {
 public:
  Localization(const patrol::OccupancyGrid& map, const Pose2& T_map_start, const patrol::Pose3& T_body_lidar,
               std::uint64_t seed);

  /// Moves the particles by odometry, and weights them by the scan if the robot has moved.
  void update(const patrol::LaserScan& scan, const Pose2& T_odom_body);

  /// Returns the pose of the body in map at a pose of odometry.
  Pose2 pose_at(const Pose2& T_odom_body) const { return T_map_odom_ * T_odom_body; }
  const Eigen::Matrix3d& covariance() const { return covariance_; }
  const mrpt::maps::COccupancyGridMap2D& map() const { return *map_; }

 private:
  mrpt::maps::COccupancyGridMap2D::Ptr map_;
  mrpt::slam::CMonteCarloLocalization2D filter_;
  patrol::Pose3 T_body_lidar_;
  Pose2 last_T_odom_body_;
  Pose2 T_map_odom_;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
};

/// Converts a scan to MRPT's. `T_body_lidar`: mount of the lidar.
mrpt::obs::CObservation2DRangeScan to_mrpt(const patrol::LaserScan& scan, const patrol::Pose3& T_body_lidar);

/// Interface of the reactive navigator to the robot: pose, obstacles and command.
class RobotInterface final : public mrpt::nav::CRobot2NavInterface {
 public:
  Time now{};
  Pose2 T_map_body, T_odom_body;
  double speed_mps = 0.0, yaw_rate_radps = 0.0;
  mrpt::maps::CSimplePointsMap obstacles;  ///< in body
  double command_mps = 0.0, command_radps = 0.0;
  bool has_reached_target = false, has_failed = false;

  bool getCurrentPoseAndSpeeds(mrpt::math::TPose2D& pose, mrpt::math::TTwist2D& velocity,
                               mrpt::system::TTimeStamp& timestamp, mrpt::math::TPose2D& odometry,
                               std::string& frame) override;
  bool changeSpeeds(const mrpt::kinematics::CVehicleVelCmd& command) override;
  bool stop(bool is_emergency) override;
  mrpt::kinematics::CVehicleVelCmd::Ptr getEmergencyStopCmd() override { return getStopCmd(); }
  mrpt::kinematics::CVehicleVelCmd::Ptr getStopCmd() override;
  bool senseObstacles(mrpt::maps::CSimplePointsMap& points, mrpt::system::TTimeStamp& timestamp) override;
  double getNavigationTime() override { return patrol::to_seconds(now) - navigation_start_s_; }
  void resetNavigationTimer() override { navigation_start_s_ = patrol::to_seconds(now); }
  void sendNavigationEndEvent() override { has_reached_target = true; }
  void sendNavigationEndDueToErrorEvent() override { has_failed = true; }
  void sendCannotGetCloserToBlockedTargetEvent() override { has_failed = true; }

 private:
  double navigation_start_s_ = 0.0;
};

/// Memory of obstacles below the plane of the lidar, from the depth camera.
class LowObstacles {
 public:
  /// `ground_m`: height of the ground in body.
  LowObstacles(const patrol::Pose3& T_body_camera, double ground_m)
      : T_body_camera_(T_body_camera), ground_m_(ground_m) {}

  void add(const patrol::DepthImage& image, const Pose2& T_odom_body);
  /// Adds the remembered points to those of a scan, in body.
  void append_to(mrpt::maps::CSimplePointsMap& points, Time now, const Pose2& T_odom_body);

 private:
  patrol::Pose3 T_body_camera_;
  double ground_m_;
  std::map<std::pair<int, int>, Time> last_seen_;  ///< by cell in odom
};

/// Drives to one goal after the other: a path on the map, followed by the reactive navigator.
class Navigation {
 public:
  Navigation(const std::vector<Eigen::Vector2d>& footprint_m, std::vector<Pose2> goals);

  /// Returns the velocity command of this instant.
  patrol::VelocityCommand step(Time now, const Localization& localization, const TrackOdometry& odometry,
                               const std::optional<patrol::LaserScan>& scan, const patrol::Pose3& T_body_lidar,
                               LowObstacles& low_obstacles);

  std::size_t num_reached() const { return next_goal_; }
  bool is_over() const { return next_goal_ >= goals_.size(); }
  const std::vector<Pose2>& path() const { return path_; }

 private:
  void plan(const mrpt::maps::COccupancyGridMap2D& map, const Pose2& T_map_body);
  Pose2 carrot() const;
  void request(const Pose2& target);

  RobotInterface robot_;
  std::unique_ptr<mrpt::nav::CReactiveNavigationSystem> navigator_;
  std::vector<Pose2> goals_;
  std::size_t next_goal_ = 0;
  std::vector<Pose2> path_;
  Time next_plan_{};
  bool has_left_ = false;  ///< the charging post
  bool is_turning_ = false;
};

}  // namespace mrpt_stack
