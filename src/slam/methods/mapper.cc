#include "slam/methods/mapper.h"

#include <array>
#include <limits>
#include <type_traits>
#include <utility>

#include "core/error.h"
#include "core/named_table.h"
#include "core/state/state_archive.h"
#include "slam/graph/graph_slam.h"
#include "slam/rbpf/scan_odometry_rbpf.h"
#include "slam/state/slam_state.h"
#include "slam/submaps/submap_rbpf.h"

namespace patrol::slam {
namespace {

/// Adapter from a mapping class to the Mapper interface. Ranges and particles are forwarded only if the class supports
/// them.
template <typename Method>
class MapperAdapter final : public Mapper {
 public:
  template <typename... Arguments>
  explicit MapperAdapter(Arguments&&... arguments) : method_(std::forward<Arguments>(arguments)...) {}

  void add(const RangeMeasurement& measurement) override {
    if constexpr (requires { method_.add(measurement); }) method_.add(measurement);
  }
  void add(const PositionMeasurement& measurement) override {
    if constexpr (requires { method_.add(measurement); }) method_.add(measurement);
  }
  bool estimates_survey() const override {
    return requires(const PositionMeasurement& position) { method_.add(position); };
  }
  SlamUpdate update(const LevelScan& scan, const Pose2& T_odom_body) override {
    if constexpr (std::is_same_v<decltype(method_.update(scan, T_odom_body)), Pose2>) {
      return {.T_map_body = method_.update(scan, T_odom_body)};
    } else {
      return method_.update(scan, T_odom_body);
    }
  }
  void finish() override { method_.finish(); }
  std::vector<Pose2> path() const override { return method_.path(); }
  OccupancyGrid map() override { return method_.map(); }
  std::vector<MappedRange> mapped_ranges() const override {
    if constexpr (requires { method_.mapped_ranges(); }) return method_.mapped_ranges();
    return {};
  }
  PoseGraph graph() const override { return method_.graph(); }
  std::optional<LoopClosureStatistics> loop_closure_statistics() const override {
    if constexpr (requires { method_.loop_closure_statistics(); }) return method_.loop_closure_statistics();
    return std::nullopt;
  }
  bool extend(const SubmapGraph& earlier) override {
    if constexpr (requires { method_.extend(earlier); }) {
      method_.extend(earlier);
      return true;
    }
    return false;
  }
  bool is_located() const override {
    if constexpr (requires { method_.is_located(); }) return method_.is_located();
    return true;
  }
  std::optional<SubmapGraph> submap_graph() const override {
    if constexpr (requires { method_.submap_graph(); }) return method_.submap_graph();
    return std::nullopt;
  }
  std::vector<std::size_t> node_scan_indices() const override { return method_.node_scan_indices(); }
  ParticleSet particles() const override {
    if constexpr (requires { method_.particles(); }) return method_.particles();
    return {};
  }

  void serialize_state(StateArchive& archive) override {
    archive.section("mapper");
    if constexpr (requires { method_.serialize_state(archive); }) {
      method_.serialize_state(archive);
    } else {
      throw InputError("snapshots: this SLAM method has none: use stack.slam.method = graph or rbpf");
    }
  }

 private:
  Method method_;
};

constexpr std::array kMethods = std::to_array<MappingMethod>({
    {"graph", "Submaps and a pose graph with loop closures, of Cartographer's class",
     [](const MapperSettings& settings, const BoostedStumps&, std::uint64_t) -> std::unique_ptr<Mapper> {
       return std::make_unique<MapperAdapter<GraphSlam>>(settings.graph);
     }},
    {"rbpf", "Rao-Blackwellized particle filter with improved proposals, of Gmapping's class",
     [](const MapperSettings& settings, const BoostedStumps&, std::uint64_t seed) -> std::unique_ptr<Mapper> {
       return std::make_unique<MapperAdapter<ScanOdometryRbpf>>(settings.rbpf, seed);
     }},
    {"submap_rbpf", "Submaps of such a filter, connected by classified neighbors ([Yu23])",
     [](const MapperSettings& settings, const BoostedStumps& neighbors, std::uint64_t seed) -> std::unique_ptr<Mapper> {
       return std::make_unique<MapperAdapter<SubmapRbpf>>(settings.submap_rbpf, neighbors, seed);
     },
     true},
});

}  // namespace

std::span<const MappingMethod> mapping_methods() { return kMethods; }

double max_tilt_rad(const MapperSettings& settings) {
  if (settings.method == "graph") return settings.graph.max_tilt_rad;
  if (settings.method == "rbpf") return settings.rbpf.filter.max_tilt_rad;
  return std::numeric_limits<double>::infinity();
}

std::unique_ptr<Mapper> make_mapper(const MapperSettings& settings, const BoostedStumps& neighbors,
                                    std::uint64_t seed) {
  validate(settings, "slam");
  return row_named(mapping_methods(), settings.method, "slam.method").make(settings, neighbors, seed);
}

}  // namespace patrol::slam
