#pragma once

#include <string>
#include <vector>

#include "core/robot_description.h"

namespace patrol::io {

/// Reads the URDF of a robot: legs, wheels or tracks, joint limits, footprint and sensor frames. Legs: four chains of
/// three revolute joints, one about x and one about y of the body in either order, then a knee about y; the foot is a
/// sphere behind the third. Names of legs and wheels do not matter. Tracks: links `<side>_track`, whose collision
/// shapes are the wheels inside the belt, and `<side>_sprocket`. Throws InputError with file and element if anything is
/// missing or not finite.
RobotDescription load_robot_description(const std::string& path);

/// Sensor frame that is added to a robot or moved, fixed to its chassis.
struct SensorMount {
  std::string frame;
  std::string parent = frame_id::kBody;                  ///< link that is fixed to the body, or the body
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< position of the frame in `parent`
  Eigen::Vector3d rpy_rad = Eigen::Vector3d::Zero();     ///< roll, pitch and yaw of the frame in `parent`
  std::string location;  ///< file, line and key for messages, "models/courier/courier.yaml:4: mounts.0"

  Pose3 T_parent_frame() const { return {position_m, quaternion_from_rpy(rpy_rad.x(), rpy_rad.y(), rpy_rad.z())}; }
};

/// Robot with the sensor frames of its mounts.
struct MountedRobot {
  RobotDescription description;
  std::string urdf;  ///< text of the URDF with the mounts; that of the file if there are none
};

/// Reads the URDF of a robot and adds the frames of mounts, or moves the frames that the file already has; the shapes
/// of a moved link move with it. Throws InputError with the location of a mount whose parent is not fixed to the body,
/// whose frame is a link that moves, or whose parent is fixed to the frame itself.
MountedRobot load_mounted_robot(const std::string& path, const std::vector<SensorMount>& mounts);

}  // namespace patrol::io
