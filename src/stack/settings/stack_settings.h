#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "stack/instruments/inspection_settings.h"
#include "core/settings.h"
#include "stack/mission/gas_mission.h"
#include "stack/mission/tunnel_mission.h"
#include "localize/amcl/monte_carlo.h"
#include "localize/body_estimator.h"
#include "localize/dock_detector.h"
#include "localize/range_filter.h"
#include "localize/scan_leveler.h"
#include "localize/track_odometry.h"
#include "plan/docking.h"
#include "plan/navigator.h"
#include "stack/sensors/sensor_watch.h"
#include "slam/mapper.h"

namespace patrol::stack {

/// Of a robot that is known: its odometry as the particle filter takes it to be, and a lidar that is levelled.
slam::GraphSlamSettings graph_of_a_known_robot();
/// Eight particles on the robot's odometry as given: its errors are known, and matching from scan to scan would only add its own.
slam::TrackedRbpfSettings rbpf_of_a_known_robot();

/// Settings of the stack: three selectors, and the settings of every part; a stack uses those of the parts that it is composed of.
struct StackSettings {
  std::string odometry_source = "legged";  ///< legged or tracked
  std::string localizer = "automatic";     ///< or slam, monte_carlo, slam_then_monte_carlo (stack/localization/make_localizer.h)
  std::string mission_type = "gas";        ///< gas: stations of a route; tunnel: marked goals, docking, instruments
  double settle_s = 1.0;  ///< after odometry's start, before the first scan makes the map's origin
  localize::BodyEstimatorSettings odometry;        ///< of a robot with legs
  localize::TrackOdometrySettings track_odometry;  ///< of a robot with tracks
  localize::ScanLevelerSettings leveling;
  std::string mapping = "graph";  ///< SLAM method (`slam::mapping_methods`), with the settings of one of the next three sections
  slam::GraphSlamSettings graph = graph_of_a_known_robot();
  slam::TrackedRbpfSettings slam = rbpf_of_a_known_robot();  ///< method `rbpf`
  slam::SubmapRbpfSettings submap_rbpf;
  localize::MonteCarloSettings localization;  ///< on a map that is known
  localize::RangeFilterSettings range_filter;  ///< of a robot with tracks and UWB: a second opinion
  plan::NavigatorSettings plan;
  SensorWatchSettings sensor_watch;
  localize::DockDetectorSettings dock_detector;
  plan::DockingSettings docking;
  GasMissionSettings mission;
  TunnelMissionSettings tour;
  InspectionSettings inspection;  ///< of a robot with its instruments

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

/// Builds the SLAM method that the settings name, from the table that `patrol slam` uses too. `neighbours` classifies pairs of submaps, for methods
/// that need it. Throws InputError when a setting breaks its rule.
std::unique_ptr<slam::Mapper> make_mapper(const StackSettings& settings, const BoostedStumps& neighbours, std::uint64_t seed);

}  // namespace patrol::stack
