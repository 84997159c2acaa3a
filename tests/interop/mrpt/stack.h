#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hello.h"
#include "link/stack_client.h"
#include "navigation.h"
#include "obstacles.h"
#include "odometry.h"
#include "positioning.h"

/// Software of a tracked or wheeled robot made of the parts of MRPT (mrpt.org): particle filter localization on a known
/// map, planner on this map or on the grid of the scans, and reactive navigator with PTGs. It knows what `patrol run
/// --stack` sends, and nothing else of Patrol.
namespace mrpt_stack {

/// The robot's software, from the hello to the end of the run.
class Stack {
 public:
  explicit Stack(patrol::link::StackClient client);

  void run();

 private:
  std::vector<std::string> topics() const;
  void receive(const patrol::link::ReceivedTurn& turn);
  void set_obstacles(const patrol::LaserScan& scan, Time now);
  void publish_state(Time now);
  void report_goals(Time now);
  Pose2 T_map_body() const { return positioning_->pose_at(odometry_.pose()); }

  patrol::link::StackClient client_;
  Task task_;
  patrol::Pose3 T_body_lidar_;
  Odometry odometry_;
  std::unique_ptr<Positioning> positioning_;
  std::optional<LowObstacles> low_obstacles_;
  Navigation navigation_;
  std::optional<patrol::LaserScan> scan_;  ///< newest of the turn
  std::size_t num_reported_ = 0;
};

}  // namespace mrpt_stack
