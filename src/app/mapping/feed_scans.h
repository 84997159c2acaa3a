#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "app/mapping/log_feeder.h"
#include "app/mapping/read_scans.h"
#include "app/run/stack_port.h"
#include "io/logs/scan_log.h"
#include "io/ros/ros_messages.h"

namespace patrol::app {

/// Creates the stack of a log whose sensors have these transforms to the body.
using MakeStack = std::function<std::unique_ptr<StackPort>(const io::TransformSet& mounts)>;

/// Reads a log to its end. Throws InputError for an unreadable record, and if the pose of the lidar on the body
/// changes.
void check_scans(io::ScanLog& log, const std::string& file);

/// Feeds a stack with the scans and the odometry of a recorded log, lossless, and writes them with the answers to
/// `log_mcap`. The stack has its turns at the ends of scans, the first at the end of the first scan. Each scan is
/// preceded by odometry at its stamp and, if its beams have times, at its last beam. `begin`: called once before
/// anything is written. Throws InputError.
FedAnswers feed_scans(io::ScanLog& log, const std::string& name, const MakeStack& make_stack,
                      const std::function<void()>& begin, const std::filesystem::path& log_mcap,
                      const InterruptGuard& guard);

}  // namespace patrol::app
