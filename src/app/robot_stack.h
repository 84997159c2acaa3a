#pragma once

#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "core/messages.h"
#include "core/part_clock.h"
#include "core/robot_description.h"
#include "core/route.h"
#include "inspect/mission.h"
#include "localize/body_estimator.h"
#include "localize/map_pose_tracker.h"
#include "localize/scan_leveler.h"
#include "plan/navigator.h"
#include "slam/grid_slam.h"

namespace patrol::app {

struct StackSettings {
  double settle_s = 1.0;  ///< after odometry's start, before the first scan makes the map's origin
  localize::BodyEstimatorSettings odometry;
  localize::ScanLevelerSettings leveling;
  slam::GridSlamSettings slam;
  plan::NavigatorSettings navigation;
  inspect::MissionSettings mission;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("settle_s", self.settle_s, between(0.0, 60.0));
    visit("odometry", self.odometry);
    visit("leveling", self.leveling);
    visit("slam", self.slam);
    visit("navigation", self.navigation);
    visit("mission", self.mission);
  }
};

/// What the stack says.
using StackMessage =
    std::variant<OdometryEstimate, PoseEstimate, ParticleSet, MapUpdate, Path, VelocityCommand, Event>;

/// The robot's own software, put together: odometry, levelling, SLAM, navigation, mission. It sees sensor messages and
/// nothing else; a recorded log can take the twin's place.
class RobotStack {
 public:
  /// `route` in map, whose origin is the level body pose at the start. Throws InputError when settings, robot and route do
  /// not go together.
  RobotStack(const StackSettings& settings, const RobotDescription& robot, const Route& route_in_map, double map_period_s,
             std::uint64_t seed);

  void handle(const SensorMessage& message);
  /// The robot's firmware reports a fall.
  void handle_fall(Time now);
  /// Mission, planning and control, once a control period; call at every tick.
  void step(Time now);

  const VelocityCommand& command() const { return command_; }
  MapUpdate final_map(Time now) const { return {now, slam_.map()}; }
  bool mission_is_over() const { return mission_.is_over(); }
  const inspect::Mission& mission() const { return mission_; }
  /// What was said since the last call, in order.
  std::vector<StackMessage> take_messages() { return std::exchange(messages_, {}); }
  const PartClock& clock() const { return clock_; }

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
