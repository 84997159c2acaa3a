#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/boosted_stumps.h"
#include "core/grid.h"
#include "core/messages.h"
#include "core/pose_graph.h"
#include "core/settings.h"
#include "slam/graph/graph_slam.h"
#include "slam/range_update.h"
#include "slam/slam_update.h"
#include "slam/submaps/submap_rbpf.h"
#include "slam/tracked_rbpf.h"

namespace patrol::slam {

class Mapper;
struct MapperSettings;

/// Row of the table of SLAM methods, for runs (`stack.mapping`) and recorded logs (`patrol slam --method`).
struct MappingMethod {
  std::string_view name;     ///< text in settings and on the command line
  std::string_view summary;  ///< one line of documentation
  std::unique_ptr<Mapper> (*make)(const MapperSettings& settings, const BoostedStumps& neighbours, std::uint64_t seed);
  bool needs_neighbor_model = false;  ///< whether it classifies pairs of submaps
};

std::span<const MappingMethod> mapping_methods();

struct MapperSettings {
  std::string method = "graph";
  GraphSlamSettings graph;
  TrackedRbpfSettings rbpf;
  SubmapRbpfSettings submap_rbpf;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("method", self.method, one_of(mapping_methods()));
    visit("graph", self.graph);
    visit("rbpf", self.rbpf);
    visit("submap_rbpf", self.submap_rbpf);
  }
};

/// What maps from scans and odometry, by whatever method: online, and when no scan will follow once more over all of them.
class Mapper {
 public:
  virtual ~Mapper() = default;

  /// A UWB range of before the next scan. A method that has no use for them leaves them out.
  virtual void add(const RangeSighting& sighting) = 0;
  /// Where the body is now, in map, whose origin is where the first scan was taken; `T_odom_body` at the scan's stamp. A method that does not know how surely
  /// leaves the covariance zero.
  virtual SlamUpdate update(const LevelScan& scan, const Pose2& T_odom_body) = 0;
  /// No scan will follow.
  virtual void finish() = 0;

  /// [scan]: of every scan that was given, as is believed now.
  virtual std::vector<Pose2> path() const = 0;
  virtual OccupancyGrid map() = 0;
  /// As of the last keyframe; empty, of a method that has none.
  virtual ParticleSet particles() const = 0;
  /// Keyframes and what is known of how they lie to each other. A method without loop closures has odometry's edges only.
  virtual PoseGraph graph() const = 0;
  /// [node of the graph]: the number of the scan that was taken there.
  virtual std::vector<std::size_t> node_scans() const = 0;
};

/// Builds the method of that name. `neighbours` classifies pairs of submaps, for methods that need it.
/// Throws InputError when a setting breaks its rule.
std::unique_ptr<Mapper> make_mapper(const MapperSettings& settings, const BoostedStumps& neighbours, std::uint64_t seed);

}  // namespace patrol::slam
