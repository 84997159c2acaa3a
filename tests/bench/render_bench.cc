// What a replay frame costs beyond the drawing itself: painter, smoothed edges and overlay against a bare
// loop of mjr_render and mjr_readPixels, of the same size and the same scenes along the street.
//   tests/bench/render_bench        `ratio` is to be at most 1.15
// And what a frame of the depth camera costs at places along the street, wall time: to be at most 4 ms.
// Processor time of all threads: the software renderer's own are most of it.

#include <cmath>
#include <ctime>
#include <numbers>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "io/urdf.h"
#include "render/overlay.h"
#include "render/scene/antialias.h"
#include "render/scene/depth_renderer.h"
#include "render/scene/scene_painter.h"
#include "sim/model_assembly.h"

namespace patrol::bench {
namespace {

using namespace render;

constexpr int kWidth = 1280, kHeight = 720;
constexpr double kPlacesY_m[] = {10.0, 35.0, 60.0};

double process_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <typename Work>
double seconds_of(Work work) {
  const double start = process_seconds();
  work();
  return process_seconds() - start;
}

/// A run that is well under way: 150 m of paths, a full scan, a map of the whole block.
RunSnapshot busy_snapshot(const mjModel& model, std::vector<double> qpos, double y_m,
                          const std::shared_ptr<const OccupancyGrid>& map) {
  RunSnapshot snapshot;
  qpos[1] = y_m;
  snapshot.state.qpos = std::move(qpos);
  for (int body = 0; body < model.nbody; ++body) {
    if (model.body_mocapid[body] < 0) continue;
    snapshot.state.mocap.insert(snapshot.state.mocap.end(), model.body_pos + 3 * body, model.body_pos + 3 * body + 3);
    snapshot.state.mocap.insert(snapshot.state.mocap.end(), model.body_quat + 4 * body, model.body_quat + 4 * body + 4);
  }
  snapshot.T_world_body = {{11.0, y_m, 0.32}, quaternion_from_yaw(std::numbers::pi / 2.0)};
  snapshot.T_world_map = {11.0, 8.0, std::numbers::pi / 2.0};
  snapshot.T_map_body = Pose2{y_m - 8.0, 0.0, 0.0};
  for (int i = 0; i < 3000; ++i) {
    const double along = i < 1500 ? 0.05 * i : 0.05 * (3000 - i);
    snapshot.true_path.emplace_back(11.0, 8.0 + along, 0.01);
    snapshot.estimated_path.emplace_back(11.03, 8.0 + along, 0.01);
  }
  for (int i = 0; i < 200; ++i) snapshot.planned_path.emplace_back(10.9, y_m + 0.1 * i, 0.01);
  for (int i = 0; i < 1440; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 1440.0;
    snapshot.scan.emplace_back(11.0 + 4.0 * std::cos(angle), y_m + 6.0 * std::sin(angle), 0.4);
  }
  snapshot.particles.assign(30, *snapshot.T_map_body);
  snapshot.map = map;
  snapshot.event = "regulator_box_1: 6 ppm m of methane.";
  return snapshot;
}

void ReplayFrameAgainstBareRender(benchmark::State& state) {
  const std::string root = PATROL_SOURCE_DIR;
  sim::AssembledModel model = sim::assemble_model(
      root + "/worlds/street/street.xml", root + "/models/quadruped/quadruped.urdf",
      io::load_robot_description(root + "/models/quadruped/quadruped.urdf"), {11.0, 8.0, std::numbers::pi / 2.0});
  set_replay_quality(*model.view);
  SceneRenderer painter(*model.view, kWidth, kHeight);
  Overlay overlay(kHeight);
  std::vector<RunSnapshot> snapshots;
  const GridGeometry block{.resolution_m = 0.05, .width = 2000, .height = 1200, .origin_m = {-10.0, -50.0}};
  const auto map = std::make_shared<const OccupancyGrid>(block, kFree);
  for (const double y_m : kPlacesY_m) snapshots.push_back(busy_snapshot(*model.view, model.start_qpos, y_m, map));

  Frame frame;
  std::vector<float> depth;
  painter.draw(CameraRig(CameraKind::kChase).follow(snapshots[0].T_world_body, 0.05), frame,
               depth);  // compiles the shaders
  double bare_s = 0.0, replay_s = 0.0, overlay_s = 0.0;
  for (auto _ : state) {
    double this_s = 0.0;
    for (const RunSnapshot& snapshot : snapshots) {
      const View view = CameraRig(CameraKind::kChase).follow(snapshot.T_world_body, 0.05);
      this_s += seconds_of([&] {
        painter.set_state(snapshot.state);
        painter.draw(view, frame, depth);
      });
      overlay_s += seconds_of([&] {
        smooth_edges(frame);
        overlay.draw(frame, depth, view, snapshot);
      });
      bare_s += seconds_of([&] {  // the very scene that the painter has drawn
        painter.offscreen().render(painter.scene());
        painter.offscreen().read(frame);
      });
    }
    replay_s += this_s;
    state.SetIterationTime(this_s / static_cast<double>(snapshots.size()));
  }
  replay_s += overlay_s;
  const double num_frames = static_cast<double>(state.iterations()) * static_cast<double>(snapshots.size());
  state.counters["ratio"] = replay_s / bare_s;
  state.counters["bare_ms"] = 1e3 * bare_s / num_frames;
  state.counters["overlay_ms"] = 1e3 * overlay_s / num_frames;
}
BENCHMARK(ReplayFrameAgainstBareRender)->UseManualTime()->Iterations(5)->Unit(benchmark::kMillisecond);

/// Of a camera 0.4 m up that looks 27 degrees down and drives at 1 m/s, 8 m from each place. Wall time; `cpu_ms` of all
/// threads.
void DepthFrame(benchmark::State& state, const std::string& world, const std::string& robot,
                const std::vector<Pose2>& places) {
  const std::string root = PATROL_SOURCE_DIR;
  const sim::AssembledModel model =
      sim::assemble_model(root + "/worlds/" + world, root + "/models/" + robot,
                          io::load_robot_description(root + "/models/" + robot), places.front());
  const sim::DataPtr data = sim::make_data(*model.view);
  mj_forward(model.view.get(), data.get());
  const DepthCameraSettings camera;
  DepthRenderer renderer(*model.view, sim::make_lens(camera), 0.05, 1.1 * camera.range_max_m);
  sim::IdealDepthImage image;
  std::size_t frame = 0;
  int num_drawn = 0;
  renderer.draw({*model.view, *data}, {}, image);  // compiles the shaders
  const double start_s = process_seconds();
  for (auto _ : state) {
    const std::size_t step = frame++ % 40;
    const Pose2 place = places[frame / 40 % places.size()] * Pose2{0.2 * static_cast<double>(step), 0.0, 0.0};
    renderer.draw({*model.view, *data}, {{place.x, place.y, 0.4}, quaternion_from_rpy(0.0, 0.48, place.yaw)}, image);
    num_drawn += renderer.num_drawn();
  }
  state.counters["cpu_ms"] = 1e3 * (process_seconds() - start_s) / static_cast<double>(state.iterations());
  state.counters["drawn"] = static_cast<double>(num_drawn) / static_cast<double>(state.iterations());
}
constexpr double kNorth = std::numbers::pi / 2.0;
BENCHMARK_CAPTURE(DepthFrame, street, "street/street.xml", "quadruped/quadruped.urdf",
                  {{11.0, 10.0, kNorth}, {11.0, 35.0, kNorth}, {11.0, 60.0, kNorth}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(240);
BENCHMARK_CAPTURE(DepthFrame, tunnel, "tunnel/tunnel.xml", "tracked/tracked.urdf",
                  {{6.0, -2.0, 0.0}, {60.0, 0.0, 0.0}, {120.0, 3.0, 0.3}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->Iterations(240);

}  // namespace
}  // namespace patrol::bench
