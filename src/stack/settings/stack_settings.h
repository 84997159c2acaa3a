#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "stack/instruments/inspection_settings.h"
#include "core/settings.h"
#include "stack/mission/gas_mission.h"
#include "stack/mission/tunnel_mission.h"
#include "localize/amcl/monte_carlo_settings.h"
#include "localize/body_estimator_settings.h"
#include "localize/dock_detector_settings.h"
#include "localize/range_filter_settings.h"
#include "localize/scan_leveler_settings.h"
#include "localize/track_odometry_settings.h"
#include "plan/control/docking.h"
#include "plan/navigation/navigator.h"
#include "stack/sensors/sensor_monitor.h"
#include "slam/methods/mapper_settings.h"

namespace patrol::stack {

/// Returns the default graph SLAM settings for the project's robots: odometry with the error model of the particle
/// filter, and a leveled lidar.
slam::GraphSlamSettings default_graph_settings();
/// Returns the default RBPF settings for the project's robots: eight particles propagated by odometry. Its errors are
/// modeled, and scan-to-scan matching would add its own.
slam::ScanOdometryRbpfSettings default_rbpf_settings();

/// Settings of the stack: three selectors and the settings of all components. A stack uses those of the components that
/// it is composed of.
struct StackSettings {
  std::string odometry_source = "legged";  ///< odometry source: legged or tracked
  std::string localizer = "automatic";     ///< automatic, slam, monte_carlo or slam_then_monte_carlo
                                           ///< (stack/localization/make_localizer.h)
  std::string mission_type = "gas";        ///< gas: stations of a route; tunnel: saved goals, docking, instruments
  double settle_s = 1.0;  ///< time from the start of odometry to the first scan, which defines the map's origin
  localize::BodyEstimatorSettings odometry;        ///< settings for a robot with legs
  localize::TrackOdometrySettings track_odometry;  ///< settings for a robot with tracks
  localize::ScanLevelerSettings leveling;
  std::string mapping = "graph";  ///< SLAM method (`slam::mapping_methods`); its settings are in one of the next three
                                  ///< sections
  slam::GraphSlamSettings graph = default_graph_settings();
  slam::ScanOdometryRbpfSettings slam = default_rbpf_settings();  ///< settings of method `rbpf`
  slam::SubmapRbpfSettings submap_rbpf;
  localize::MonteCarloSettings localization;  ///< settings of the localization on a given map
  localize::RangeFilterSettings range_filter;  ///< settings of the UWB pose of a robot with tracks and UWB
  plan::NavigatorSettings plan;
  SensorMonitorSettings sensor_watch;
  localize::DockDetectorSettings dock_detector;
  plan::DockingSettings docking;
  GasMissionSettings mission;
  TunnelMissionSettings tour;
  InspectionSettings inspection;  ///< settings for a robot with inspection instruments

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("odometry_source", self.odometry_source, one_of({"legged", "tracked"}));
    visit("localizer", self.localizer, one_of({"automatic", "slam", "monte_carlo", "slam_then_monte_carlo"}));
    visit("mission_type", self.mission_type, one_of({"gas", "tunnel"}));
    visit("settle_s", self.settle_s, between(0.0, 60.0));
    visit("odometry", self.odometry);
    visit("track_odometry", self.track_odometry);
    visit("leveling", self.leveling);
    visit("mapping", self.mapping, one_of(slam::mapping_methods()));
    visit("graph", self.graph);
    visit("slam", self.slam);
    visit("submap_rbpf", self.submap_rbpf);
    visit("localization", self.localization);
    visit("range_filter", self.range_filter);
    visit("plan", self.plan);
    visit("sensor_watch", self.sensor_watch);
    visit("dock_detector", self.dock_detector);
    visit("docking", self.docking);
    visit("mission", self.mission);
    visit("tour", self.tour);
    visit("inspection", self.inspection);
  }
};

/// Makes the SLAM method named by the settings, from the table that `patrol slam` also uses. `neighbours` classifies
/// submap pairs, for methods that need it. Throws InputError when a setting is out of range.
std::unique_ptr<slam::Mapper> make_mapper(const StackSettings& settings, const BoostedStumps& neighbor_model, std::uint64_t seed);

}  // namespace patrol::stack
