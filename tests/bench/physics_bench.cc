// What scenery costs physics: a step of the walking robot in the street against the same robot on a bare
// plane.
//   tests/bench/physics_bench                       `ratio` is to be at most 1.2

#include <benchmark/benchmark.h>

#include "tests/bench/ratio.h"
#include "tests/sim/walking_robot.h"

namespace patrol::bench {
namespace {

using sim::WalkingRobot;

constexpr int kTicksPerTurn = 25;

void StreetAgainstBarePlane(benchmark::State& state) {
  const VelocityCommand walk{.stamp = {},
                             .vx_mps = static_cast<double>(state.range(0)) / 100.0,
                             .vy_mps = 0.0,
                             .yaw_rate_radps = 0.0};
  WalkingRobot in_street(sim::assemble_model(sim::kStreetXml, sim::kRobotUrdf, sim::kStreetStart));
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
  if (in_street.controller().has_fallen() || on_plane.controller().has_fallen())
    state.SkipWithError("the robot fell");
  ratio.report(state);
}
BENCHMARK(StreetAgainstBarePlane)
    ->Arg(0)
    ->Arg(50)
    ->ArgName("speed_cmps")
    ->UseManualTime()
    ->Iterations(200)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace patrol::bench
