#include "app/scoring/world_surfaces.h"

#include "app/scoring/mapping_lidar.h"
#include "render/reference_map.h"
#include "sim/model_assembly.h"

namespace patrol::app {
namespace {

double lidar_height_m(const ScenarioFiles& files) {
  return sim::start_height_m(files.world_xml.string(), files.simulated_robot(), files.robot, files.T_site_start) +
         mapping_height_in_body_m(files.robot);
}

}  // namespace

WorldSurfaces world_surfaces(const ScenarioFiles& files, double resolution_m) {
  const sim::SpecPtr spec = sim::load_spec(files.world_xml.string());
  sim::drop_textures(*spec);
  WorldSurfaces seen{
      .world = sim::compile(*spec, files.world_xml.string()), .lidar_height_m = lidar_height_m(files), .surfaces = {}};
  seen.surfaces = render::reference_map(
                      *seen.world, {.height_m = seen.lidar_height_m, .resolution_m = resolution_m, .margin_m = 0.0})
                      .map;
  return seen;
}

}  // namespace patrol::app
