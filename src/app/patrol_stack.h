#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "app/robot_stack.h"
#include "localize/map_pose_tracker.h"

namespace patrol::app {

/// The quadruped's: it maps while it patrols. Leg odometry, levelling, SLAM, navigation, gas mission.
class PatrolStack final : public RobotStack {
 public:
  /// `route` in map, whose origin is the level body pose at the start. Throws InputError when settings, robot and route do
  /// not go together.
  PatrolStack(const StackSettings& settings, const RobotDescription& robot, const Route& route_in_map, double map_period_s,
              std::uint64_t seed);

  void handle(const SensorMessage& message) override;
  void handle_fall(Time now) override;
  void step(Time now) override;

  const VelocityCommand& command() const override { return command_; }
  MapUpdate final_map(Time now) const override { return {now, slam_.map()}; }
  bool mission_is_over() const override { return mission_.is_over(); }
  std::vector<StackMessage> take_messages() override { return std::exchange(messages_, {}); }
  const PartClock& clock() const override { return clock_; }

 private:
  void handle_scan(const LaserScan& scan);
  void publish_map(Time now);
  void note(Time now, const PoseEstimate& pose, const char* kind, const char* text);

  localize::BodyEstimator odometry_;
  localize::ScanLeveler leveler_;
  slam::GridSlam slam_;
  localize::MapPoseTracker tracker_;
  plan::Navigator navigator_;
  inspect::Mission mission_;

  Time settle_;
  std::optional<Time> first_odometry_;
  std::optional<GasReading> newest_gas_;
  VelocityCommand command_;
  Time map_period_;
  Time next_control_{};
  plan::NavigationStatus status_ = plan::NavigationStatus::kIdle;  ///< a control period ago
  Time next_odometry_{};
  Time next_map_{};
  std::vector<StackMessage> messages_;
  PartClock clock_;
};

}  // namespace patrol::app
