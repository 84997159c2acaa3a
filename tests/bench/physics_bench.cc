// What scenery costs physics: a step of the walking robot in the street against the same robot on a bare
// plane. And what tracks cost: a tick of the tracked robot on rubble, firmware, belts and all, against a bare mj_step
// of the same model under the same orders. And what the closed form of its contacts saves.
//   tests/bench/physics_bench                       `ratio` is to be at most 1.2

#include <benchmark/benchmark.h>

#include "io/urdf.h"
#include "tests/bench/ratio.h"
#include "tests/sim/rubble.h"
#include "tests/support/simulated_quadruped.h"
#include "tests/support/simulated_tracked_robot.h"

namespace patrol::bench {
namespace {

using sim::WalkingRobot;

constexpr int kTicksPerTurn = 25;

void StreetAgainstBarePlane(benchmark::State& state) {
  const VelocityCommand walk{
      .stamp = {}, .vx_mps = static_cast<double>(state.range(0)) / 100.0, .vy_mps = 0.0, .yaw_rate_radps = 0.0};
  WalkingRobot in_street(sim::assemble_model(sim::kStreetXml, sim::kRobotUrdf,
                                             io::load_robot_description(sim::kRobotUrdf), sim::kStreetStart));
  WalkingRobot on_plane(sim::make_flat_world(), sim::kStreetStart);
  in_street.stand(1.0);
  on_plane.stand(1.0);
  Ratio ratio;
  for (auto _ : state) {
    double street_s = 0.0;
    for (int tick = 0; tick < kTicksPerTurn; ++tick) {
      in_street.drive(walk);
      on_plane.drive(walk);
      ratio.reference([&] { on_plane.advance(); });
      street_s += ratio.subject([&] { in_street.advance(); });
    }
    state.SetIterationTime(street_s / kTicksPerTurn);
  }
  if (in_street.controller().has_fallen() || on_plane.controller().has_fallen()) state.SkipWithError("the robot fell");
  ratio.report(state);
}
BENCHMARK(StreetAgainstBarePlane)
    ->Arg(0)
    ->Arg(50)
    ->ArgName("speed_cmps")
    ->UseManualTime()
    ->Iterations(200)
    ->Unit(benchmark::kMicrosecond);

/// `yaw_crps`: driving straight at 0.5 m/s when 0, else turning on the spot. `elliptic`: cones of friction.
void TracksOnRubbleAgainstBareStep(benchmark::State& state) {
  const double yaw_rate = static_cast<double>(state.range(0)) / 100.0;
  const VelocityCommand command{
      .stamp = {}, .vx_mps = yaw_rate == 0.0 ? 0.5 : 0.0, .vy_mps = 0.0, .yaw_rate_radps = yaw_rate};
  const std::string world = sim::make_rubble_world(24.0, 6.0);
  sim::TrackedRobot whole(world, {-10.0, 0.0, 0.0}), bare(world, {-10.0, 0.0, 0.0});
  if (state.range(1) != 0) whole.options().cone = bare.options().cone = mjCONE_ELLIPTIC;
  Ratio ratio;
  double all_s = 0.0, ticks = 0.0;
  for (auto _ : state) {
    double whole_s = 0.0;
    for (int tick = 0; tick < kTicksPerTurn; ++tick) {
      bare.command_drive(command);
      ratio.reference([&] { mj_step(&bare.model(), &bare.data()); });
      whole_s += ratio.subject([&] { whole.step(command); });
    }
    state.SetIterationTime(whole_s / kTicksPerTurn);
    all_s += whole_s;
    ticks += kTicksPerTurn;
  }
  state.counters["real_time_factor"] = whole.model().opt.timestep * ticks / all_s;
  ratio.report(state);
}
BENCHMARK(TracksOnRubbleAgainstBareStep)
    ->ArgsProduct({{0, 40}, {0, 1}})
    ->ArgNames({"yaw_crps", "elliptic"})
    ->UseManualTime()
    ->Iterations(200)
    ->Unit(benchmark::kMicrosecond);

/// The collision functions of MuJoCo before Patrol replaces one (sim/height_field_contact.h).
const mjfCollision kGeneralContact = mjCOLLISIONFUNC[mjGEOM_HFIELD][mjGEOM_SPHERE];

/// Contacts of the tracked robot's wheels with rubble in closed form, against MuJoCo's general algorithm.
void WheelContactsAgainstGeneralAlgorithm(benchmark::State& state) {
  sim::TrackedRobot robot(sim::make_rubble_world(24.0, 6.0), {-10.0, 0.0, 0.0});
  mjfCollision& contact = mjCOLLISIONFUNC[mjGEOM_HFIELD][mjGEOM_SPHERE];
  const mjfCollision closed_form = contact;
  Ratio ratio;
  for (auto _ : state) {
    contact = kGeneralContact;
    ratio.reference([&] { mj_collision(&robot.model(), &robot.data()); });
    contact = closed_form;
    state.SetIterationTime(ratio.subject([&] { mj_collision(&robot.model(), &robot.data()); }));
  }
  ratio.report(state);
}
BENCHMARK(WheelContactsAgainstGeneralAlgorithm)->UseManualTime()->Iterations(2000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace patrol::bench
