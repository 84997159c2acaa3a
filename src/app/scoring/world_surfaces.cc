#include "app/scoring/world_surfaces.h"

#include <algorithm>

#include "render/reference_map.h"
#include "sim/model_assembly.h"

namespace patrol::app {
namespace {

double lidar_height_m(const ScenarioFiles& files) {
  const sim::AssembledModel assembled =
      sim::assemble_model(files.world_xml.string(), files.simulated_robot(), files.robot, files.T_site_start);
  const sim::DataPtr data = sim::make_data(*assembled.physics);
  std::copy(assembled.start_qpos.begin(), assembled.start_qpos.end(), data->qpos);
  mj_kinematics(assembled.physics.get(), data.get());
  const int body = mj_name2id(assembled.physics.get(), mjOBJ_BODY, frame_id::kBody);
  return data->xpos[3 * body + 2] + files.robot.T_body("lidar").position.z();
}

}  // namespace

WorldSurfaces world_surfaces(const ScenarioFiles& files, double resolution_m) {
  const sim::SpecPtr spec = sim::load_spec(files.world_xml.string());
  WorldSurfaces seen{
      .world = sim::compile(*spec, files.world_xml.string()), .lidar_height_m = lidar_height_m(files), .surfaces = {}};
  seen.surfaces = render::reference_map(
                      *seen.world, {.height_m = seen.lidar_height_m, .resolution_m = resolution_m, .margin_m = 0.0})
                      .map;
  return seen;
}

}  // namespace patrol::app
