#include "app/scoring/true_map.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/scoring/mapping_lidar.h"
#include "render/reference_map.h"

namespace patrol::app {
namespace {

constexpr double kReferenceResolution_m = 0.025;

double mean_lidar_height_m(const RunRecord& record, const ScenarioFiles& files) {
  double height_m = 0.0;
  for (const StampedPose& entry : record.T_world_body) height_m += entry.pose.position.z();
  return height_m / static_cast<double>(record.T_world_body.size()) + mapping_height_in_body_m(files.robot);
}

}  // namespace

TrueMap true_map(const RunRecord& record, const Scenario& scenario, const ScenarioFiles& files) {
  const sim::SpecPtr spec = sim::load_spec(files.world_xml.string());
  sim::drop_textures(*spec);
  TrueMap truth{.world = sim::compile(*spec, files.world_xml.string()),
                .lidar_height_m = mean_lidar_height_m(record, files),
                .reference = {}};
  std::vector<std::string> actors;
  for (const sim::ActorSettings& actor : scenario.actors) actors.push_back(actor.name);
  std::vector<Eigen::Vector2d> visited_m;
  for (const StampedPose& entry : record.T_world_body) visited_m.push_back(entry.pose.position.head<2>());
  const render::ReferenceMap map = render::reference_map(*truth.world, {.height_m = truth.lidar_height_m,
                                                                        .resolution_m = kReferenceResolution_m,
                                                                        .actors = std::move(actors),
                                                                        .visited_m = std::move(visited_m)});
  truth.reference_agreement = map.check.agreement_ratio();
  const std::optional<MappingLidar> lidar = mapping_lidar(files.robot);
  const LidarSettings& settings = lidar ? scenario.sensors.*lidar->settings : scenario.sensors.lidar;
  truth.reference = score::mark_observable(map.map, record.T_world_body, settings.range_max_m);
  return truth;
}

}  // namespace patrol::app
