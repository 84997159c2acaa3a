#include "app/check/check_pictures.h"

#include <cmath>

#include "app/common/temporary_folder.h"
#include "io/files/atomic_file.h"
#include "render/scene/antialias.h"
#include "render/scene/scene_painter.h"
#include "sim/model_assembly.h"

namespace patrol::app {
namespace {

constexpr int kWidth = 640, kHeight = 400;

/// View from the front left, at a distance that shows the whole robot.
render::View view_of(const CheckRobot& robot, const PictureScene& scene) {
  const double size_m = robot.description.outline_radius_m();
  const Eigen::Vector3d p_m = scene.T_world_body.position;
  const Eigen::Vector3d eye_m = p_m + size_m * Eigen::Vector3d(1.9, 3.2, 1.5);
  return render::look_at(eye_m, p_m + Eigen::Vector3d(0.0, 0.0, 0.1 * size_m));
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
  renderer.draw(view_of(robot, scene), frame, depth);
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
