// The lidar's rays in the street against MuJoCo's and against bare Embree.
//   tests/bench/lidar_bench
// AgainstMjMultiRay: `speed_up` is to be at least 10. AgainstBareEmbree, in cones as the lidar casts them: `ratio` is
// to be at most 1.2.

#include "sim/sensors/lidar.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <benchmark/benchmark.h>
#include <embree3/rtcore.h>

#include "io/urdf.h"
#include "sim/lidar_scene.h"
#include "sim/robot_model.h"
#include "tests/bench/ratio.h"
#include "tests/support/simulated_quadruped.h"

namespace patrol::bench {
namespace {

using sim::WalkingRobot;

constexpr int kBeams = 3200;
constexpr double kRange_m = 30.0;

/// The robot some steps into its way through the street, and the rays of one revolution of its lidar.
struct Street {
  Street()
      : robot(sim::assemble_model(sim::kStreetXml, sim::kRobotUrdf, io::load_robot_description(sim::kRobotUrdf),
                                  sim::kStreetStart)),
        data(sim::make_data(robot.view())),
        scene(robot.view()) {
    robot.stand(1.0);
    for (int tick = 0; tick < 500; ++tick) take_step();
    const Pose3 T_world_lidar = robot.T_world_body() * T_body_lidar;
    origin = T_world_lidar.position;
    for (int beam = 0; beam < kBeams; ++beam) {
      const double angle = 2.0 * std::numbers::pi * beam / kBeams;
      directions.push_back(T_world_lidar.rotation * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0));
    }
  }

  void take_step() {
    robot.step({.stamp = {}, .vx_mps = 0.5, .vy_mps = 0.0, .yaw_rate_radps = 0.0});
    scene.update(robot.data());
  }

  WalkingRobot robot;
  sim::DataPtr data;  ///< data of the view model
  sim::LidarScene scene;
  Pose3 T_body_lidar = io::load_robot_description(sim::kRobotUrdf).T_body_sensor.at("lidar");
  Eigen::Vector3d origin;
  std::vector<Eigen::Vector3d> directions;
};

double cast_all(const Street& street) {
  double sum = 0.0;
  for (const Eigen::Vector3d& direction : street.directions) {
    const auto hit = street.scene.cast(street.origin, direction, kRange_m, sim::kRayEverything & ~sim::kRayLidar2d);
    if (hit) sum += hit->distance_m;
  }
  return sum;
}

/// Casts the rays in cones of 32 beams, as the lidar does.
double cast_in_cones(const Street& street) {
  constexpr std::size_t kRaysPerCone = 32;
  std::vector<sim::Ray> rays;
  std::vector<std::optional<sim::RayHit>> hits(kRaysPerCone);
  double sum = 0.0;
  for (std::size_t begin = 0; begin < street.directions.size(); begin += kRaysPerCone) {
    const std::span directions = std::span(street.directions).subspan(begin, kRaysPerCone);
    const Eigen::Vector3d axis = (directions.front() + directions.back()).normalized();
    const double cosine = axis.dot(directions.front()) - 1e-6;
    const sim::RayCone cone{.center = street.origin,
                            .radius_m = 1e-6,
                            .axis = axis,
                            .cosine = cosine,
                            .sine = std::sqrt(1.0 - cosine * cosine)};
    const auto targets =
        street.scene.targets(street.scene.poses(), cone, kRange_m, sim::kRayEverything & ~sim::kRayLidar2d);
    rays.clear();
    for (const Eigen::Vector3d& direction : directions) rays.push_back({street.origin, direction});
    street.scene.cast(targets, rays, hits);
    for (const auto& hit : hits) sum += hit ? hit->distance_m : 0.0;
  }
  return sum;
}

void RaysAgainstMjMultiRay(benchmark::State& state) {
  Street street;
  const mjModel& view = street.robot.view();
  std::copy_n(street.robot.state().qpos, view.nq, street.data->qpos);
  mj_forward(&view, street.data.get());
  const mjtByte seen[mjNGROUP] = {1, 0, 1, 0, 1, 0};
  std::vector<int> geoms(kBeams);
  std::vector<mjtNum> distances(kBeams);
  Ratio ratio;
  for (auto _ : state) {
    ratio.reference([&] {
      mj_multiRay(&view, street.data.get(), street.origin.data(), street.directions.front().data(), seen, 1, -1,
                  geoms.data(), distances.data(), nullptr, kBeams, kRange_m);
    });
    state.SetIterationTime(ratio.subject([&] { benchmark::DoNotOptimize(cast_all(street)); }));
  }
  ratio.report(state);
}
BENCHMARK(RaysAgainstMjMultiRay)->UseManualTime()->Unit(benchmark::kMicrosecond);

/// The same world with everything in one Embree scene where it is now, but for the housing in which the rays
/// begin.
sim::ModelPtr freeze(const Street& street) {
  sim::ModelPtr frozen(mj_copyModel(nullptr, &street.robot.view()));
  std::copy_n(street.robot.state().qpos, frozen->nq, frozen->qpos0);
  for (int geom = 0; geom < frozen->ngeom; ++geom) {
    const char* body = mj_id2name(frozen.get(), mjOBJ_BODY, frozen->geom_bodyid[geom]);
    if (body != nullptr && std::string_view(body) == "lidar") frozen->geom_group[geom] = sim::kGroupRobotCollision;
  }
  std::fill_n(frozen->body_weldid, frozen->nbody, 0);
  return frozen;
}

void RaysAgainstBareEmbree(benchmark::State& state) {
  Street street;
  const sim::ModelPtr frozen = freeze(street);
  const sim::LidarScene frozen_scene(*frozen);
  RTCSceneTy* still = frozen_scene.static_scene();
  Ratio ratio;
  for (auto _ : state) {
    ratio.reference([&] {
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      for (const Eigen::Vector3d& direction : street.directions) {
        RTCRayHit ray{};
        ray.ray.org_x = static_cast<float>(street.origin.x());
        ray.ray.org_y = static_cast<float>(street.origin.y());
        ray.ray.org_z = static_cast<float>(street.origin.z());
        ray.ray.dir_x = static_cast<float>(direction.x());
        ray.ray.dir_y = static_cast<float>(direction.y());
        ray.ray.dir_z = static_cast<float>(direction.z());
        ray.ray.tfar = static_cast<float>(kRange_m);
        ray.ray.mask = 0xffffffffu;
        ray.hit.geomID = ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(still, &context, &ray);
        benchmark::DoNotOptimize(ray.ray.tfar);
      }
    });
    state.SetIterationTime(ratio.subject([&] { benchmark::DoNotOptimize(cast_in_cones(street)); }));
  }
  ratio.report(state);
}
BENCHMARK(RaysAgainstBareEmbree)->UseManualTime()->Unit(benchmark::kMicrosecond);

/// Cost of a tick of 2 ms with moved bodies, 64 fired beams and noise.
void LidarTick(benchmark::State& state) {
  Street street;
  sim::Lidar lidar(LidarSettings::of_preset("rplidar_s2"), street.scene, street.T_body_lidar, sim::kRayLidar2d, 1,
                   "lidar");
  double update_s = 0.0, all_s = 0.0;
  Time now{};
  constexpr Time kTick = std::chrono::milliseconds(2);
  for (auto _ : state) {
    const Pose3 before = street.robot.T_world_body();
    street.robot.step({.stamp = {}, .vx_mps = 0.5, .vy_mps = 0.0, .yaw_rate_radps = 0.0});
    const double start = thread_cpu_time_s();
    street.scene.update(street.robot.data());
    const double updated = thread_cpu_time_s();
    lidar.advance(now, now + kTick, before, street.robot.T_world_body());
    const double end = thread_cpu_time_s();
    now += kTick;
    lidar.take_scans();
    update_s += updated - start;
    all_s += end - start;
    state.SetIterationTime(end - start);
  }
  state.counters["share_of_update"] = update_s / all_s;
}
BENCHMARK(LidarTick)->UseManualTime()->Iterations(2000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace patrol::bench
