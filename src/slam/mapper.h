#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

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

/// graph: submaps and a pose graph, of Cartographer's class; rbpf: a particle filter with improved proposals, of Gmapping's; submap_rbpf: submaps of such
/// a filter, joined (paper 002).
inline Limits mapping_methods() { return one_of({"graph", "rbpf", "submap_rbpf"}); }

struct MapperSettings {
  std::string method = "graph";
  GraphSlamSettings graph;
  TrackedRbpfSettings rbpf;
  SubmapRbpfSettings submap_rbpf;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("method", self.method, mapping_methods());
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

/// `neighbours` recognises neighbouring submaps, for submap_rbpf.
/// Throws InputError when a setting breaks its rule.
std::unique_ptr<Mapper> make_mapper(const MapperSettings& settings, const BoostedStumps& neighbours, std::uint64_t seed);
/// The same of one method, for a robot whose odometry can be relied on.
std::unique_ptr<Mapper> make_graph_mapper(const GraphSlamSettings& settings);
std::unique_ptr<Mapper> make_rbpf_mapper(const GridSlamSettings& settings, std::uint64_t seed);

}  // namespace patrol::slam
