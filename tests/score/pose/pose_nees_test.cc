#include "score/pose/pose_nees.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "core/geometry/linear_algebra.h"
#include "core/random.h"

namespace patrol::score::pose_nees_test {
namespace {

using namespace std::chrono_literals;

/// Estimates of one true pose with Gaussian errors of a given covariance.
struct Plant {
  Trajectory T_map_body, T_world_body;
  Pose2 T_world_map{3.0, -2.0, 2.5};
  Eigen::Matrix3d covariance;

  explicit Plant(int num_poses) {
    covariance << 4e-4, 1e-4, 2e-5, 1e-4, 9e-4, -3e-5, 2e-5, -3e-5, 1e-4;
    const Eigen::Matrix3d root = cholesky_factor(covariance);
    const RandomStream stream(1, "plant");
    const Pose2 true_T_map_body{1.0, 2.0, 3.1};  // the errors cross the half turn
    for (int i = 0; i < num_poses; ++i) {
      const auto tick = static_cast<std::uint64_t>(i);
      const Eigen::Vector3d e =
          root * Eigen::Vector3d(stream.normal(tick, 0), stream.normal(tick, 1), stream.normal(tick, 2));
      const Pose2 estimate{true_T_map_body.x + e.x(), true_T_map_body.y + e.y(),
                           wrap_angle(true_T_map_body.yaw + e.z())};
      T_map_body.push_back({i * 100ms, to_pose3(estimate)});
      T_world_body.push_back({i * 100ms, to_pose3(T_world_map * true_T_map_body)});
    }
  }

  /// Score with the standard deviations claimed `factor` times as large as they are.
  PoseNees claimed(double factor) const {
    return pose_nees(T_map_body, std::vector<Eigen::Matrix3d>(T_map_body.size(), factor * factor * covariance),
                     T_world_map, T_world_body);
  }
};

// NEES of Gaussian errors is chi squared with 3 degrees of freedom: mean 3, variance 6. The bounds are 3.3 standard
// deviations of the mean and of the fraction over 4000 poses.
TEST(PoseNees, OfAConsistentCovarianceIsItsDimension) {
  const PoseNees score = Plant(4000).claimed(1.0);
  EXPECT_EQ(score.num_instants, 4000U);
  EXPECT_EQ(score.num_singular, 0U);
  EXPECT_NEAR(score.mean, 3.0, 3.3 * std::sqrt(6.0 / 4000.0));
  EXPECT_NEAR(score.per_dimension(), 1.0, 1.1 * std::sqrt(6.0 / 4000.0));
  EXPECT_NEAR(score.within_95, 0.95, 3.3 * std::sqrt(0.95 * 0.05 / 4000.0));
}

TEST(PoseNees, OfHalvedStandardDeviationsIsFourTimesThatAndOfDoubledOnesAQuarter) {
  const Plant plant(4000);
  EXPECT_NEAR(plant.claimed(0.5).mean, 4.0 * plant.claimed(1.0).mean, 1e-6);
  EXPECT_NEAR(plant.claimed(2.0).mean, 0.25 * plant.claimed(1.0).mean, 1e-6);
  EXPECT_NEAR(plant.claimed(0.5).per_dimension(), 4.0, 4.0 * 1.1 * std::sqrt(6.0 / 4000.0));
  // P(chi squared <= 7.8147 / 4) with 3 degrees of freedom: erf(sqrt(x / 2)) - sqrt(2 x / pi) exp(-x / 2)
  const double x = 7.814728 / 4.0;
  const double inside = std::erf(std::sqrt(x / 2.0)) - std::sqrt(2.0 * x / std::numbers::pi) * std::exp(-x / 2.0);
  EXPECT_NEAR(plant.claimed(0.5).within_95, inside, 3.3 * std::sqrt(inside * (1.0 - inside) / 4000.0));
  EXPECT_GT(plant.claimed(2.0).within_95, 0.999);
}

/// Score of one pose with an error along x and standard deviations of 0.1 m, 0.1 m and 0.01 rad.
PoseNees with_error(double error_m, const Eigen::Matrix3d& covariance) {
  const Trajectory truth = {{Time(0s), {}}, {Time(1s), {}}};
  return pose_nees({{Time(500ms), to_pose3({error_m, 0.0, 0.0})}}, {covariance}, {}, truth);
}

TEST(PoseNees, InsideTheEllipsoidIsUpToAboutTwoPointEightStandardDeviationsOfOneCoordinate) {
  const Eigen::Matrix3d covariance = Eigen::Vector3d(0.01, 0.01, 0.0001).asDiagonal();
  EXPECT_NEAR(with_error(0.279, covariance).mean, 2.79 * 2.79, 1e-9);
  EXPECT_EQ(with_error(0.279, covariance).within_95, 1.0);
  EXPECT_EQ(with_error(0.280, covariance).within_95, 0.0);
}

// The map is turned by 3 mrad about its origin: 0.12 m at 40 m. The pose in map is exact.
TEST(PoseNees, ContainsTheRegistrationWithItsLever) {
  const Pose2 T_site_map{11.0, 8.0, 0.5}, T_map_body{40.0, 0.0, 0.0};
  const Pose2 turned{11.0, 8.0, 0.503};
  const Eigen::Matrix3d by_pose = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
  const Eigen::Matrix3d by_map = Eigen::Vector3d(0.0, 0.0, 9e-6).asDiagonal();
  const Trajectory truth = {{Time(0s), to_pose3(T_site_map * T_map_body)},
                            {Time(1s), to_pose3(T_site_map * T_map_body)}};
  const PoseNees score = pose_nees({{Time(500ms), to_pose3(T_map_body)}}, {by_pose},
                                   {T_site_map, {{.stamp = {}, .T_site_map = turned, .covariance = by_map}}}, truth);
  // Across: variance of the pose 1e-4, of the map 9e-6 with a lever of 40 m, both in yaw. e = 3e-3 (40, 1).
  Eigen::Matrix2d P;
  P << 1e-4 + 1600.0 * 9e-6, 40.0 * 9e-6, 40.0 * 9e-6, 1e-6 + 9e-6;
  const Eigen::Vector2d e(0.12, 3e-3);
  EXPECT_NEAR(score.mean, e.dot(P.inverse() * e), 5e-3);
  EXPECT_EQ(score.within_95, 1.0);
}

TEST(PoseNees, ASingularCovarianceHasNoNeesAndIsOutside) {
  for (const Eigen::Vector3d& variances :
       {Eigen::Vector3d(0.0, 0.0, 0.0), Eigen::Vector3d(0.01, 0.01, 0.0), Eigen::Vector3d(0.01, 1e-13, 0.01),
        Eigen::Vector3d(0.01, -0.01, 0.01), Eigen::Vector3d(std::numeric_limits<double>::quiet_NaN(), 1.0, 1.0)}) {
    const PoseNees score = with_error(0.0, variances.asDiagonal());
    EXPECT_EQ(score.num_instants, 1U);
    EXPECT_EQ(score.num_singular, 1U);
    EXPECT_FALSE(score.has_mean());
    EXPECT_EQ(score.within_95, 0.0);
  }
}

TEST(PoseNees, OutsideTheTimeOfTheTruthThereIsNone) {
  const PoseNees score = pose_nees({{Time(5s), {}}}, {Eigen::Matrix3d::Identity()}, {}, {{Time(0s), {}}});
  EXPECT_EQ(score.num_instants, 0U);
  EXPECT_FALSE(score.has_mean());
}

}  // namespace
}  // namespace patrol::score::pose_nees_test
