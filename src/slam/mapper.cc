#include "slam/mapper.h"

#include <array>
#include <type_traits>
#include <utility>

#include "core/named_table.h"

namespace patrol::slam {
namespace {

/// Any class with a mapper's members, behind the interface; ranges and particles where it has them.
template <typename Method>
class MapperOf final : public Mapper {
 public:
  template <typename... Arguments>
  explicit MapperOf(Arguments&&... arguments) : method_(std::forward<Arguments>(arguments)...) {}

  void add(const RangeSighting& sighting) override {
    if constexpr (requires { method_.add(sighting); }) method_.add(sighting);
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
  PoseGraph graph() const override { return method_.graph(); }
  std::vector<std::size_t> node_scans() const override { return method_.node_scans(); }
  ParticleSet particles() const override {
    if constexpr (requires { method_.particles(); }) return method_.particles();
    return {};
  }

 private:
  Method method_;
};

constexpr std::array kMethods = std::to_array<MappingMethod>({
    {"graph", "Submaps and a pose graph with loop closures, of Cartographer's class",
     [](const MapperSettings& settings, const BoostedStumps&, std::uint64_t) -> std::unique_ptr<Mapper> {
       return std::make_unique<MapperOf<GraphSlam>>(settings.graph);
     }},
    {"rbpf", "Rao-Blackwellized particle filter with improved proposals, of Gmapping's class",
     [](const MapperSettings& settings, const BoostedStumps&, std::uint64_t seed) -> std::unique_ptr<Mapper> {
       return std::make_unique<MapperOf<TrackedRbpf>>(settings.rbpf, seed);
     }},
    {"submap_rbpf", "Submaps of such a filter, connected by classified neighbors (paper 002)",
     [](const MapperSettings& settings, const BoostedStumps& neighbours, std::uint64_t seed) -> std::unique_ptr<Mapper> {
       return std::make_unique<MapperOf<SubmapRbpf>>(settings.submap_rbpf, neighbours, seed);
     },
     true},
});

}  // namespace

std::span<const MappingMethod> mapping_methods() { return kMethods; }

std::unique_ptr<Mapper> make_mapper(const MapperSettings& settings, const BoostedStumps& neighbours, std::uint64_t seed) {
  validate(settings, "slam");
  return row_named(mapping_methods(), settings.method, "slam.method").make(settings, neighbours, seed);
}

}  // namespace patrol::slam
