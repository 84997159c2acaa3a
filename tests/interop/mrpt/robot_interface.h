#pragma once

#include <string>

#include <mrpt/kinematics/CVehicleVelCmd_DiffDriven.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/nav/reactive/CRobot2NavInterface.h>

#include "core/frames.h"
#include "core/time.h"

namespace mrpt_stack {

using patrol::Pose2;
using patrol::Time;

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

}  // namespace mrpt_stack
