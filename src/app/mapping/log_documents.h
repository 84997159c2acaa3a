#pragma once

#include <string>

#include "app/mapping/log_mapping.h"
#include "app/run/external_stack.h"
#include "core/frames.h"
#include "io/ros/ros_messages.h"

namespace patrol::app {

/// Transforms of the sensors of a recorded log: that of the lidar.
io::TransformSet lidar_mount(const Pose2& T_body_lidar);
/// Returns the pose of the lidar on the body. Throws InputError if the transforms lack it.
Pose2 T_body_lidar_of(const io::TransformSet& mounts);

/// Documents for a stack in another process that is fed with a recorded log: no robot, no site, and the settings of the
/// built-in mapping. `name`: of the log. `mounts`: transforms of the sensors.
StackDocuments log_documents(const std::string& name, const LogMappingSettings& settings,
                             const io::TransformSet& mounts);

/// Returns whether a hello is that of a recorded log.
inline bool is_recorded_log(const link::Hello& hello) { return hello.robot.empty(); }

/// Reads the settings of the mapping from a hello. Throws InputError.
LogMappingSettings mapping_settings_of(const link::Hello& hello);

}  // namespace patrol::app
