// One step of FastSLAM 1.0 against the loop that it cannot do without.
//   tests/bench/particle_bench
// Both go once round the same circle with the same odometry and sights, N particles and eight landmarks of which all
// are seen. The reference is a bare loop on plain arrays as anybody would write it: for every particle draw two normals
// from the same stream, move, and for every landmark predict range and bearing, add up the logarithm of the Gaussian
// likelihood, and update mean and covariance of the landmark. The subject is the whole step: also weights, estimate,
// association and resampling. `ratio` is to be at most 1.3; `particles_per_second` is to be the same for all N.

#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include "core/random.h"
#include "studies/landmarks/fast_slam.h"
#include "tests/bench/ratio.h"
#include "tests/studies/landmarks/circle_world.h"

namespace patrol::bench {
namespace {

using studies::RangeBearing;

test::CircleWorld bench_world() {
  test::CircleWorld world;
  world.range_m = 20.0;  // all are seen
  return world;
}

/// Plain arrays: [particle], and [particle x landmarks + landmark].
class BareLoop {
 public:
  BareLoop(const test::CircleWorld& world, std::size_t particles)
      : world_(world),
        landmarks_(static_cast<std::size_t>(world.num_landmarks)),
        x_(particles),
        y_(particles),
        yaw_(particles),
        log_weight_(particles),
        mx_(particles * landmarks_),
        my_(mx_),
        pxx_(mx_),
        pxy_(mx_),
        pyy_(mx_),
        is_seen_(mx_.size(), 0) {}

  double step(const studies::Control& control, const std::vector<RangeBearing>& seen) {
    RandomSequence random(stream_, steps_++);
    const double dt = world_.motion.step_s, R0 = std::pow(world_.noise.range_std_m, 2),
                 R1 = std::pow(world_.noise.bearing_std_rad, 2);
    double sum = 0.0;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const double v = control.x() + world_.motion.std.x() * random.normal(),
                   w = control.y() + world_.motion.std.y() * random.normal();
      x_[i] += v * dt * std::cos(yaw_[i] + 0.5 * w * dt);
      y_[i] += v * dt * std::sin(yaw_[i] + 0.5 * w * dt);
      yaw_[i] = wrap_angle(yaw_[i] + w * dt);
      for (const RangeBearing& sight : seen) {
        const std::size_t k = i * landmarks_ + static_cast<std::size_t>(sight.landmark);
        is_seen_[k] ? correct(i, k, sight, R0, R1) : begin(i, k, sight, R0, R1);
      }
      sum += log_weight_[i];
    }
    return sum;
  }

 private:
  void correct(std::size_t i, std::size_t k, const RangeBearing& sight, double R0, double R1) {
    const double dx = mx_[k] - x_[i], dy = my_[k] - y_[i], q = dx * dx + dy * dy, r = std::sqrt(q);
    const double nu0 = sight.range_m - r, nu1 = wrap_angle(sight.bearing_rad + yaw_[i] - std::atan2(dy, dx));
    const double h00 = dx / r, h01 = dy / r, h10 = -dy / q, h11 = dx / q;
    const double a00 = pxx_[k] * h00 + pxy_[k] * h01, a01 = pxx_[k] * h10 + pxy_[k] * h11;  // P H^T
    const double a10 = pxy_[k] * h00 + pyy_[k] * h01, a11 = pxy_[k] * h10 + pyy_[k] * h11;
    const double s00 = h00 * a00 + h01 * a10 + R0, s01 = h00 * a01 + h01 * a11, s11 = h10 * a01 + h11 * a11 + R1;
    const double det = s00 * s11 - s01 * s01, i00 = s11 / det, i01 = -s01 / det, i11 = s00 / det;
    log_weight_[i] -= 0.5 * (nu0 * (i00 * nu0 + i01 * nu1) + nu1 * (i01 * nu0 + i11 * nu1) + std::log(det));
    const double k00 = a00 * i00 + a01 * i01, k01 = a00 * i01 + a01 * i11, k10 = a10 * i00 + a11 * i01,
                 k11 = a10 * i01 + a11 * i11;
    mx_[k] += k00 * nu0 + k01 * nu1;
    my_[k] += k10 * nu0 + k11 * nu1;
    pxx_[k] -= k00 * a00 + k01 * a01;
    pxy_[k] -= k00 * a10 + k01 * a11;
    pyy_[k] -= k10 * a10 + k11 * a11;
  }

  void begin(std::size_t i, std::size_t k, const RangeBearing& sight, double R0, double R1) {
    const double c = std::cos(yaw_[i] + sight.bearing_rad), s = std::sin(yaw_[i] + sight.bearing_rad),
                 across = sight.range_m * sight.range_m * R1;
    mx_[k] = x_[i] + sight.range_m * c;
    my_[k] = y_[i] + sight.range_m * s;
    pxx_[k] = c * c * R0 + s * s * across;
    pxy_[k] = c * s * (R0 - across);
    pyy_[k] = s * s * R0 + c * c * across;
    is_seen_[k] = 1;
  }

  test::CircleWorld world_;
  std::size_t landmarks_;
  RandomStream stream_{1, "slam/landmarks/particles"};
  std::uint64_t steps_ = 0;
  std::vector<double> x_, y_, yaw_, log_weight_, mx_, my_, pxx_, pxy_, pyy_;
  std::vector<char> is_seen_;
};

void StepAgainstBareLoop(benchmark::State& state) {
  const auto particles = static_cast<std::size_t>(state.range(0));
  const test::CircleWorld world = bench_world();
  const test::Drive drive = test::drive(world, 1);
  Ratio ratio;
  double sum = 0.0, subject_s = 0.0;
  std::size_t num_steps = 0;
  for (auto _ : state) {  // one round
    BareLoop bare(world, particles);
    studies::FastSlam slam({.particles = static_cast<int>(particles)}, world.motion, world.noise,
                           slam::make_components({}), 1);
    double round_s = 0.0;
    for (std::size_t k = 0; k < drive.controls.size(); ++k, ++num_steps) {
      ratio.reference([&] { sum += bare.step(drive.controls[k], drive.observations[k]); });
      round_s += ratio.subject([&] { sum += slam.step(drive.controls[k], drive.observations[k]).T_map_body.x; });
    }
    subject_s += round_s;
    state.SetIterationTime(round_s);
    benchmark::DoNotOptimize(sum);
  }
  ratio.report(state);
  state.counters["particles_per_second"] = static_cast<double>(particles * num_steps) / subject_s;
}
BENCHMARK(StepAgainstBareLoop)
    ->Arg(10)
    ->Arg(100)
    ->Arg(1000)
    ->ArgName("particles")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace patrol::bench
