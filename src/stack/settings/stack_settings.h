#pragma once

#include <string>

#include "core/settings.h"
#include "localize/amcl/monte_carlo_settings.h"
#include "localize/calibration/online_calibrator_settings.h"
#include "localize/line_of_sight_monitor_settings.h"
#include "localize/range_filter_settings.h"
#include "localize/registration/registration_settings.h"
#include "localize/scan_leveler_settings.h"
#include "plan/navigation/navigator_settings.h"
#include "slam/methods/mapper_settings.h"
#include "stack/instruments/inspection_settings.h"
#include "stack/mission/gas_mission_settings.h"
#include "stack/mission/tunnel_mission_settings.h"
#include "stack/sensors/sensor_monitor_settings.h"
#include "stack/settings/docking_settings.h"
#include "stack/settings/odometry_settings.h"

namespace patrol::stack {

/// Returns the default graph SLAM settings for the project's robots: odometry with the error model of the particle
/// filter, and a leveled lidar.
slam::GraphSlamSettings default_graph_settings();
/// Returns the default RBPF settings for the project's robots: eight particles propagated by odometry. Its errors are
/// modeled, and scan-to-scan matching would add its own.
slam::ScanOdometryRbpfSettings default_rbpf_settings();

/// Returns the default SLAM settings for the project's robots, with `default_graph_settings` and
/// `default_rbpf_settings`.
slam::MapperSettings default_slam_settings();

/// Computing time of the stack in simulated time.
struct ComputeSettings {
  /// Model: free takes no simulated time; fixed takes delay_s for every turn, beside the simulator; measured takes the
  /// CPU time of the turn.
  std::string model = "free";
  double delay_s = 0.02;  ///< time from the start of a turn until its messages take effect, model fixed
  double factor = 1.0;    ///< ratio of the robot's computing time to that of this computer, model measured

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("model", self.model, one_of({"free", "fixed", "measured"}));
    visit("delay_s", self.delay_s, between(0.0, 10.0));
    visit("factor", self.factor, between(0.0, 1000.0));
  }
};

/// Settings of the stack: three selectors and the settings of all components. A stack uses those of the components that
/// it is composed of.
struct StackSettings {
  std::string odometry_source = "legged";  ///< odometry source: legged, tracked or wheeled
  /// Localizer: automatic, slam, monte_carlo or slam_then_monte_carlo (stack/localization/make_localizer.h).
  std::string localizer = "automatic";
  /// Time from the arrival of a scan until the pose that SLAM computes from it takes effect. Until then the pose
  /// follows odometry.
  double slam_delay_s = 0.0;
  /// Type of the mission: gas for the stations of a route; tunnel for saved goals, docking and instruments.
  std::string mission_type = "gas";
  /// Time from the start of odometry to the first scan, which defines the map's origin.
  double odometry_settling_time_s = 1.0;
  OdometrySettings odometry;
  localize::ScanLevelerSettings scan_leveling;
  localize::OnlineCalibratorSettings calibration;  ///< settings of the calibration while the robot drives
  slam::MapperSettings slam = default_slam_settings();
  localize::MonteCarloSettings localization;           ///< settings of the localization on a given map
  localize::RangeFilterSettings uwb_filter;            ///< settings of the UWB pose of a robot with tracks and UWB
  localize::LineOfSightMonitorSettings line_of_sight;  ///< settings of the selection of UWB ranges
  localize::RegistrationSettings registration;         ///< settings of the registration of the map to the site
  plan::NavigatorSettings navigation;
  SensorMonitorSettings sensor_monitor;
  DockingSettings docking;
  GasMissionSettings gas_mission;
  TunnelMissionSettings tunnel_mission;
  InspectionSettings inspection;  ///< settings for a robot with inspection instruments
  /// Command of a stack that replaces the built-in one, or the address unix:PATH or tcp:127.0.0.1:PORT at which it
  /// connects (src/link/README.md); empty: the built-in stack.
  std::string command;
  double timeout_s = 30.0;       ///< limit of the wall time that a stack in another process takes for a turn
  double memory_limit_mb = 0.0;  ///< limit of the memory of a stack that is started by its command; 0: none
  bool allow_network = false;    ///< permission for an address that other machines reach
  ComputeSettings compute;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("odometry_source", self.odometry_source, one_of({"legged", "tracked", "wheeled"}));
    visit("localizer", self.localizer, one_of({"automatic", "slam", "monte_carlo", "slam_then_monte_carlo"}));
    visit("slam_delay_s", self.slam_delay_s, between(0.0, 10.0));
    visit("mission_type", self.mission_type, one_of({"gas", "tunnel"}));
    visit("odometry_settling_time_s", self.odometry_settling_time_s, between(0.0, 60.0));
    visit("odometry", self.odometry);
    visit("scan_leveling", self.scan_leveling);
    visit("calibration", self.calibration);
    visit("slam", self.slam);
    visit("localization", self.localization);
    visit("uwb_filter", self.uwb_filter);
    visit("line_of_sight", self.line_of_sight);
    visit("registration", self.registration);
    visit("navigation", self.navigation);
    visit("sensor_monitor", self.sensor_monitor);
    visit("docking", self.docking);
    visit("gas_mission", self.gas_mission);
    visit("tunnel_mission", self.tunnel_mission);
    visit("inspection", self.inspection);
    visit("command", self.command);
    visit("timeout_s", self.timeout_s, between(0.1, 86400.0));
    visit("memory_limit_mb", self.memory_limit_mb, at_least(0.0));
    visit("allow_network", self.allow_network);
    visit("compute", self.compute);
  }
};

}  // namespace patrol::stack
