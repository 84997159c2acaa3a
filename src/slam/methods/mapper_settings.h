#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/boosted_stumps.h"
#include "core/settings.h"
#include "slam/graph/graph_slam_settings.h"
#include "slam/rbpf/scan_odometry_rbpf_settings.h"
#include "slam/submaps/submap_rbpf_settings.h"

namespace patrol::slam {

class Mapper;
struct MapperSettings;

/// Row of the table of SLAM methods, for runs (`stack.slam.method`) and recorded logs (`patrol slam --method`).
struct MappingMethod {
  std::string_view name;     ///< text in settings and on the command line
  std::string_view summary;  ///< one line of documentation
  std::unique_ptr<Mapper> (*make)(const MapperSettings& settings, const BoostedStumps& neighbors, std::uint64_t seed);
  bool needs_neighbor_model = false;  ///< whether it classifies pairs of submaps
};

std::span<const MappingMethod> mapping_methods();

/// Returns the tilt above which the selected method does not use scans; infinite for methods without such a limit.
double max_tilt_rad(const MapperSettings& settings);

/// Settings of all SLAM methods and the selected one.
struct MapperSettings {
  std::string method = "graph";  ///< SLAM method (`patrol list`)
  GraphSlamSettings graph;
  ScanOdometryRbpfSettings rbpf;
  SubmapRbpfSettings submap_rbpf;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("method", self.method, one_of(mapping_methods()));
    visit("graph", self.graph);
    visit("rbpf", self.rbpf);
    visit("submap_rbpf", self.submap_rbpf);
  }
};

}  // namespace patrol::slam
