#include "slam/rbpf/particle_problem.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "slam/particle_filter.h"
#include "slam/scan_integration.h"
#include "tests/slam/street_walk.h"

namespace patrol::slam::particle_problem_test {
namespace {

/// A map of the street's first sights, and a scan from where the walk begins.
struct Start {
  GridMap map{0.05, 400.0};
  std::vector<MatchPoint> points;
  ScanMatcherSettings matching;
};

Start start_of_the_street() {
  const test::RoomWorld street = test::make_street();
  const Pose2 T_world_start = test::make_walk({.period_s = 0.2}, 1).front().T_world_body;
  const RandomStream noise(1, "test/lidar");
  Start start;
  LevelScan scan;
  for (std::uint64_t i = 0; i < 10; ++i) {
    scan = street.scan(T_world_start, Time{}, {.beams = 800, .range_std_m = 0.01}, noise, i);
    integrate_scan(scan, {}, {}, start.map);
  }
  start.points = downsample_scan(scan, start.matching.point_spacing_m, start.matching.max_points);
  return start;
}

/// Odometry that is 10 cm off and says that it may be.
PoseGaussian wrong_prediction() {
  PoseGaussian prediction{.mean = {0.1, 0.0, 0.0}};
  prediction.covariance = Eigen::Vector3d(0.01, 0.01, 1e-4).asDiagonal();
  return prediction;
}

double mean_error_m(const std::string& optimizer, const Start& start) {
  std::vector<Particle> particles(20, {.T_map_body = {}, .map = start.map});
  RbpfParticleProblem step(particles, std::vector<PoseGaussian>(particles.size(), wrong_prediction()), start.points,
                           0.2, start.matching);
  std::vector<double> log_weights(particles.size(), 0.0);
  RandomSequence random(RandomStream(3, "test/particles"), 0);
  propagate_and_weight(step, make_components({.optimizer = optimizer}), random, log_weights);
  double error_m = 0.0;
  for (const Particle& particle : particles)
    error_m += particle.T_map_body.position().norm() / static_cast<double>(particles.size());
  return error_m;
}

TEST(RbpfParticleProblem, AnIncrementOfZeroIsTheOdometryAndOneOfOneADeviationBeyond) {
  const Start start = start_of_the_street();
  std::vector<Particle> particles(1, {.T_map_body = {}, .map = start.map});
  RbpfParticleProblem step(particles, {wrong_prediction()}, start.points, 0.2, start.matching);
  step.commit(0, Eigen::Vector3d::Zero());
  EXPECT_DOUBLE_EQ(particles[0].T_map_body.x, 0.1);
  step.commit(0, Eigen::Vector3d(1.0, -1.0, 1.0));
  EXPECT_NEAR(particles[0].T_map_body.x, 0.2, 1e-12);
  EXPECT_NEAR(particles[0].T_map_body.y, -0.1, 1e-12);
  EXPECT_NEAR(particles[0].T_map_body.yaw, 0.01, 1e-12);
}

// Deviations of 10 cm about a prediction that is 10 cm off: E |(0.1 + 0.1 x, 0.1 y)| is about 0.155 m for normal x, y.
TEST(RbpfParticleProblem, SwarmsReduceTheErrorOfOdometrySamplesByAThird) {
  const Start start = start_of_the_street();
  const double drawn_m = mean_error_m("none", start);
  EXPECT_NEAR(drawn_m, 0.155, 0.05);
  for (const char* optimizer : {"woa", "ba", "fa", "ifa", "scso", "iscso"})
    EXPECT_LT(mean_error_m(optimizer, start), 0.67 * drawn_m) << optimizer;
}

TEST(RbpfParticleProblem, AParticleThatIsAttractedByAnotherTakesItsMapAndAFractionOfItsIncrement) {
  const Start start = start_of_the_street();
  std::vector<Particle> particles = {{.T_map_body = {}, .map = GridMap(0.05, 400.0)},
                                     {.T_map_body = {}, .map = start.map}};
  RbpfParticleProblem step(particles, {wrong_prediction(), wrong_prediction()}, start.points, 0.2, start.matching);
  step.commit(0, Eigen::Vector3d(2.0, 0.0, 0.0));
  step.commit(1, Eigen::Vector3d(0.0, 2.0, 0.0));
  step.apply_resampling({{.parent = 0, .attractor = 1, .attraction = 0.25}, {.parent = 1}});
  EXPECT_NEAR(particles[0].T_map_body.x, 0.1 + 0.1 * 1.5, 1e-12);  // 2 + 0.25 (0 - 2)
  EXPECT_NEAR(particles[0].T_map_body.y, 0.1 * 0.5, 1e-12);
  EXPECT_TRUE(particles[0].map.has_surface());
  EXPECT_NEAR(particles[1].T_map_body.y, 0.2, 1e-12);
}

TEST(ScanLogLikelihood, IsMaximalNearTheGroundTruthAndLowOutsideTheMap) {
  const Start start = start_of_the_street();
  const auto at = [&](const Pose2& pose) { return scan_log_likelihood(start.map, start.points, pose, start.matching); };
  for (const Pose2& off : {Pose2{0.1, 0.0, 0.0}, Pose2{0.0, -0.1, 0.0}, Pose2{0.0, 0.0, 0.02}, Pose2{5.0, 3.0, 0.5},
                           Pose2{1000.0, 0.0, 0.0}}) {
    EXPECT_LT(at(off), at({})) << off.x << " " << off.y << " " << off.yaw;
  }
  EXPECT_LE(at({1000.0, 0.0, 0.0}), at({5.0, 3.0, 0.5}));
}

}  // namespace
}  // namespace patrol::slam::particle_problem_test
