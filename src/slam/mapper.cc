#include "slam/mapper.h"

namespace patrol::slam {
namespace {

/// Any class with a mapper's members, behind the interface.
template <typename Method>
class MapperOf final : public Mapper {
 public:
  template <typename... Arguments>
  explicit MapperOf(Arguments&&... arguments) : method_(std::forward<Arguments>(arguments)...) {}

  Pose2 update(const LevelScan& scan, const Pose2& T_odom_body) override { return method_.update(scan, T_odom_body); }
  void finish() override { method_.finish(); }
  std::vector<Pose2> path() const override { return method_.path(); }
  OccupancyGrid map() const override { return method_.map(); }
  PoseGraph graph() const override { return method_.graph(); }
  std::vector<std::size_t> node_scans() const override { return method_.node_scans(); }

 private:
  Method method_;
};

}  // namespace

std::unique_ptr<Mapper> make_mapper(const MapperSettings& settings, const BoostedStumps& neighbours, std::uint64_t seed) {
  validate(settings, "slam");
  if (settings.method == "rbpf") return std::make_unique<MapperOf<TrackedRbpf>>(settings.rbpf, seed);
  if (settings.method == "submap_rbpf") return std::make_unique<MapperOf<SubmapRbpf>>(settings.submap_rbpf, neighbours, seed);
  return std::make_unique<MapperOf<GraphSlam>>(settings.graph);
}

}  // namespace patrol::slam
