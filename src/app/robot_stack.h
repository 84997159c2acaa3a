#pragma once

#include <variant>
#include <vector>

#include "core/messages.h"
#include "core/part_clock.h"
#include "core/robot_description.h"
#include "core/route.h"
#include "inspect/mission.h"
#include "inspect/tour.h"
#include "localize/amcl/monte_carlo.h"
#include "localize/body_estimator.h"
#include "localize/dock_detector.h"
#include "localize/scan_leveler.h"
#include "localize/track_odometry.h"
#include "plan/docking.h"
#include "plan/navigator.h"
#include "slam/grid_slam.h"

namespace patrol::app {

/// Of every part that some robot has; each stack takes what it is built of.
struct StackSettings {
  double settle_s = 1.0;  ///< after odometry's start, before the first scan makes the map's origin
  localize::BodyEstimatorSettings odometry;        ///< of a robot with legs
  localize::TrackOdometrySettings track_odometry;  ///< of a robot with tracks
  localize::ScanLevelerSettings leveling;
  slam::GridSlamSettings slam;
  localize::MonteCarloSettings localization;  ///< on a map that is known
  plan::NavigatorSettings navigation;
  localize::DockDetectorSettings dock_detector;
  plan::DockingSettings docking;
  inspect::MissionSettings mission;
  inspect::TourSettings tour;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("settle_s", self.settle_s, between(0.0, 60.0));
    visit("odometry", self.odometry);
    visit("track_odometry", self.track_odometry);
    visit("leveling", self.leveling);
    visit("slam", self.slam);
    visit("localization", self.localization);
    visit("navigation", self.navigation);
    visit("dock_detector", self.dock_detector);
    visit("docking", self.docking);
    visit("mission", self.mission);
    visit("tour", self.tour);
  }
};

/// What the stack says.
using StackMessage =
    std::variant<OdometryEstimate, PoseEstimate, LocalizationTrust, ParticleSet, MapUpdate, Path, VelocityCommand, Event>;

/// The robot's own software, put together. It sees sensor messages and nothing else; a recorded log can take the twin's place.
class RobotStack {
 public:
  virtual ~RobotStack() = default;

  virtual void handle(const SensorMessage& message) = 0;
  /// The robot's firmware reports a fall.
  virtual void handle_fall(Time now) = 0;
  /// Mission, planning and control, once a control period; call at every tick.
  virtual void step(Time now) = 0;

  virtual const VelocityCommand& command() const = 0;
  virtual MapUpdate final_map(Time now) const = 0;
  virtual bool mission_is_over() const = 0;
  /// What was said since the last call, in order.
  virtual std::vector<StackMessage> take_messages() = 0;
  virtual const PartClock& clock() const = 0;
};

/// For std::visit.
template <typename... Handlers>
struct Overloaded : Handlers... {
  using Handlers::operator()...;
};

inline inspect::NavigationFeedback feedback_of(plan::NavigationStatus status) {
  switch (status) {
    case plan::NavigationStatus::kArrived:
      return inspect::NavigationFeedback::kArrived;
    case plan::NavigationStatus::kFailed:
      return inspect::NavigationFeedback::kFailed;
    default:
      return inspect::NavigationFeedback::kDriving;
  }
}

}  // namespace patrol::app
