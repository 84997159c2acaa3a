#include "app/check/check_pictures.h"

#include "app/common/temporary_folder.h"
#include "io/files/atomic_file.h"
#include "render/scene/antialias.h"
#include "render/scene/scene_painter.h"
#include "sim/geom_box.h"
#include "sim/model_assembly.h"
#include "sim/robot_model.h"

namespace patrol::app {
namespace {

constexpr int kWidth = 640, kHeight = 400;

/// Returns the box around the robot, axis-aligned in world.
Eigen::AlignedBox3d robot_box(const mjModel& view, const mjData& data) {
  Eigen::AlignedBox3d box;
  for (int geom = 0; geom < view.ngeom; ++geom) {
    const int group = view.geom_group[geom];
    if (group == sim::kGroupRobotVisual || group == sim::kGroupRobotCollision)
      box.extend(sim::geom_box(view, data, geom));
  }
  return box;
}

CheckPicture render_scene(const CheckRobot& robot, const PictureScene& scene, const std::filesystem::path& folder) {
  const std::filesystem::path world_xml = folder / "world.xml";
  io::save_text(world_xml, scene.world_mjcf);
  const sim::AssembledModel model =
      sim::assemble_model(world_xml.string(), robot.simulator.robot_urdf, robot.description, {});
  render::set_replay_quality(*model.view);
  render::SceneRenderer renderer(*model.view, kWidth, kHeight);
  renderer.set_state(scene.state);
  render::Frame frame(kWidth, kHeight);
  std::vector<float> depth;
  const Eigen::Vector3d from_front_left(1.9, 3.2, 1.5);
  renderer.draw(render::look_at(robot_box(*model.view, renderer.data()), from_front_left), frame, depth);
  render::smooth_edges(frame);
  return {.png = render::to_png(frame), .caption = scene.caption};
}

}  // namespace

std::vector<CheckPicture> render_check_pictures(const CheckResult& result) {
  const TemporaryFolder folder("check_pictures");
  std::vector<CheckPicture> pictures;
  for (const ManeuverResult& each : result.maneuvers) {
    if (each.picture) pictures.push_back(render_scene(result.robot, *each.picture, folder.path()));
  }
  return pictures;
}

}  // namespace patrol::app
