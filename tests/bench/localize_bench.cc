// One update of Monte-Carlo localisation against the loop that it cannot do without.
//   tests/bench/localize_bench
// Both see 2,000 particles about the truth in the tunnel of the tests and the same 360 beams. The reference is a bare
// likelihood-field loop as anybody would write it: for every particle and beam, turn the end, find its cell, add up the
// field. The subject is the whole update: motion, ranges, scan, clumps, pose refinement, trust, KLD and resampling.
// `ratio` is to be at most 1.3.

#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include "localize/amcl/distance_to_occupied.h"
#include "localize/amcl/monte_carlo.h"
#include "tests/bench/ratio.h"
#include "tests/support/tunnel_world.h"

namespace patrol::bench {
namespace {

using localize::BeamEnds, localize::MonteCarloLocalizer, localize::MonteCarloSettings;

constexpr int kParticles = 2000;
constexpr int kBeams = 360;

MonteCarloSettings bench_settings() {
  MonteCarloSettings settings;
  settings.kld.min_particles = settings.kld.max_particles = kParticles;
  settings.likelihood_field.max_beams = kBeams;
  settings.max_logged_particles = 0;
  return settings;
}

/// log-likelihood of a beam's end, [cell]; outside as far from everything.
class PlainField {
 public:
  explicit PlainField(const OccupancyGrid& map) : log_likelihood_(map.geometry()) {
    const Grid<float> distance_m = localize::distance_to_occupied(map, 0.4);
    for (std::size_t i = 0; i < log_likelihood_.values().size(); ++i) {
      const float ratio = distance_m.values()[i] / 0.1F;
      log_likelihood_.values()[i] = std::log(0.95F * std::exp(-0.5F * ratio * ratio) + 0.05F);
    }
  }

  float sum(const BeamEnds& ends, const Pose2& pose) const {
    const GridGeometry& geometry = log_likelihood_.geometry();
    const auto c = static_cast<float>(std::cos(pose.yaw)), s = static_cast<float>(std::sin(pose.yaw));
    const auto x = static_cast<float>(pose.x - geometry.origin_m.x()),
               y = static_cast<float>(pose.y - geometry.origin_m.y());
    const auto inverse_resolution = static_cast<float>(1.0 / geometry.resolution_m);
    float total = 0.0F;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const float px = (x + c * ends.x_m[i] - s * ends.y_m[i]) * inverse_resolution;
      const float py = (y + s * ends.x_m[i] + c * ends.y_m[i]) * inverse_resolution;
      const Cell cell{static_cast<int>(px), static_cast<int>(py)};
      total += px >= 0.0F && py >= 0.0F && log_likelihood_.contains(cell) ? log_likelihood_.at(cell) : std::log(0.05F);
    }
    return total;
  }

 private:
  Grid<float> log_likelihood_;
};

void UpdateAgainstBareFieldLoop(benchmark::State& state) {
  const bool with_ranges = state.range(0) != 0;
  const test::Tunnel tunnel;
  const Pose3 T_body_uwb{{-0.2, 0.1, 0.3}, Eigen::Quaterniond::Identity()};
  MonteCarloLocalizer localizer(bench_settings(), test::tunnel_map(), tunnel.anchors(), T_body_uwb, 1);
  localizer.set_initial_pose({}, Eigen::Vector3d(0.04, 0.04, 0.003).asDiagonal());
  test::TunnelDrive drive(tunnel.world, tunnel.anchors(), T_body_uwb, {}, {.speed_mps = 0.2}, 1);
  const PlainField field(test::tunnel_map());
  Ratio ratio;
  double sum = 0.0;
  for (auto _ : state) {
    for (int i = 0; i < 10; ++i) drive.step();
    if (with_ranges) {
      for (const UwbRange& range : drive.ranges()) localizer.add(range, to_pose3(drive.T_odom_body()));
    }
    const LevelScan scan = drive.scan();
    const BeamEnds ends = localize::select_beam_ends(scan, kBeams);
    const std::vector<Pose2> poses = localizer.particles().T_map_body;
    ratio.reference([&] {
      for (const Pose2& pose : poses) sum += static_cast<double>(field.sum(ends, pose));
    });
    state.SetIterationTime(
        ratio.subject([&] { sum += localizer.update(scan, drive.T_odom_body()).estimate.T_map_body.x; }));
    benchmark::DoNotOptimize(sum);
  }
  ratio.report(state);
  state.counters["particles"] = static_cast<double>(localizer.particles().size());
}
BENCHMARK(UpdateAgainstBareFieldLoop)
    ->Arg(0)
    ->Arg(1)
    ->ArgName("ranges")
    ->UseManualTime()
    ->Iterations(500)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace patrol::bench
