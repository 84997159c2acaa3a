#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "app/stack/stack_settings.h"
#include "core/messages.h"
#include "core/part_clock.h"
#include "core/robot_description.h"
#include "core/route.h"
#include "core/sensors/registry.h"
#include "inspect/navigation_feedback.h"
#include "localize/map_pose_tracker.h"
#include "plan/navigator.h"
#include "plan/sensor_watch.h"

namespace patrol::app {

/// What the stack says.
using StackMessage =
    std::variant<OdometryEstimate, PoseEstimate, RangePoseEstimate, LocalizationTrust, ParticleSet, MapUpdate, Path, VelocityCommand, Event, ScanCommand,
                 AntennaCommand, SoundingCommand, WarningCommand, LiningResult, WaterResult>;

/// The robot's own software, put together. It sees sensor messages and nothing else; a recorded log can take the twin's place.
/// Here is what every robot's has: the rhythm of odometry, map and control, the pose in map, and the navigator.
class RobotStack {
 public:
  virtual ~RobotStack() = default;

  void handle(const SensorMessage& message);
  /// The robot's firmware reports a fall.
  virtual void handle_fall(Time now) = 0;
  virtual bool mission_is_over() const = 0;

  /// Mission, planning and control, once a control period; call at every tick.
  void step(Time now);

  const VelocityCommand& command() const { return command_; }
  MapUpdate final_map(Time now) { return {now, map()}; }
  /// What was said since the last call, in order.
  std::vector<StackMessage> take_messages() { return std::exchange(messages_, {}); }
  const PartClock& clock() const { return clock_; }

 protected:
  RobotStack(const StackSettings& settings, const RobotDescription& robot, const Route& site_in_map, double map_period_s,
             std::uint64_t seed);

  virtual void use(const SensorMessage& message) = 0;
  /// Ends the mission with an event of this kind.
  virtual void abort(Time now, const char* kind, const std::string& text) = 0;
  /// Nobody holds the remote control.
  virtual bool drives_itself() const { return true; }
  virtual std::optional<OdometryEstimate> odometry() const = 0;
  virtual OccupancyGrid map() = 0;
  virtual bool is_mapping() const = 0;
  /// Once a control period: what to do now.
  virtual VelocityCommand control(Time now, const OdometryEstimate& odometry) = 0;

  /// The first scan, which makes the map's origin, waits until odometry has settled.
  bool has_settled(Time stamp) const { return first_odometry_ && stamp >= *first_odometry_ + settle_; }
  /// Matches a scan, corrects the pose in map, and says both.
  void map_scan(slam::Mapper& slam, const LevelScan& scan, const Pose2& T_odom_body);
  /// A step of the navigator, with what is to be told of it.
  plan::NavigationStep navigate(Time now, const PoseEstimate& pose);
  inspect::NavigationFeedback navigation_feedback() const;
  void publish_map(Time now);
  template <typename Message>
  void say(Message&& message) {
    messages_.emplace_back(std::forward<Message>(message));
  }
  void note(Time now, const PoseEstimate& pose, const char* kind, const std::string& text, const std::string& subject = "");

  localize::MapPoseTracker tracker_;
  plan::Navigator navigator_;
  plan::SensorWatch sensor_watch_;
  plan::NavigationStatus navigation_ = plan::NavigationStatus::kIdle;  ///< a control period ago
  PartClock clock_;

 private:
  void watch_sensors(Time now, const Pose2& T_odom_body);

  Time now_{};
  Time settle_;
  Time map_period_;
  std::optional<Time> first_odometry_;
  Time next_control_{};
  Time next_odometry_{};
  Time next_map_{};
  VelocityCommand command_;
  std::vector<StackMessage> messages_;
};

}  // namespace patrol::app
