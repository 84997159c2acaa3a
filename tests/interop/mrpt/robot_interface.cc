#include "robot_interface.h"

#include <cmath>

#include "conversions.h"

namespace mrpt_stack {

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

}  // namespace mrpt_stack
