#include "slam/submaps/ndt.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "tests/support/pose_near.h"
#include "tests/support/submap_points.h"

namespace patrol::slam::ndt_test {
namespace {

using test::make_yard, test::Pose2Near, test::RoomWorld, test::sample_walls;
using Points = std::vector<Eigen::Vector2d>;

constexpr double kExactTol = 1e-12;  // algebra

const Pose2 kTruth = test::kYardTarget.inverse() * test::kYardSource;

/// Share of the source's points that have one of the target within 15 cm.
double overlap(const Points& target, const Points& source) {
  int near = 0;
  for (const auto& p : source)
    near += std::ranges::any_of(target, [&](const auto& q) { return (kTruth * p - q).norm() < 0.15; }) ? 1 : 0;
  return near / static_cast<double>(source.size());
}

/// Of 18 starts all around, as far off as said, how many end within 5 cm and half a degree.
int num_found(const Points& target, const Points& source, double off_m, double off_rad) {
  const NdtSettings settings;
  const auto ndt = make_ndt(target, settings);
  int found = 0;
  for (int i = 0; i < 18; ++i) {
    const double direction = 60.0 * kDegree * (i % 6), turn = off_rad * (i / 6 - 1);
    const Pose2 start{kTruth.x + off_m * std::cos(direction), kTruth.y + off_m * std::sin(direction),
                      kTruth.yaw + turn};
    const auto result = align_ndt(ndt, source, start, settings);
    if (!result) continue;
    const Pose2 T_error = kTruth.inverse() * result->T_target_source;
    found += T_error.position().norm() < 0.05 && std::abs(T_error.yaw) < 0.5 * kDegree ? 1 : 0;
  }
  return found;
}

// Four points at the corners of a square of 2 a about a node: every one counts by (1 - a/h)^2 there, h half the cell.
// Their mean is the node, their covariance a^2 in either axis.
TEST(NdtGrid, FourPointsAboutANodeAreANormalOfTheirMeanAndCovariance) {
  const double a = 0.25;
  const NdtGrid grid({{a, a}, {-a, a}, {a, -a}, {-a, -a}}, 2.0, 0.01);
  EXPECT_EQ(grid.num_cells(), 9U);
  EXPECT_NEAR(grid.score({{0.0, 0.0}}, {}).value, 1.0, kExactTol) << "on the node only its cell counts";
  // Half way to the node on the right, whose cell has the two points on its left side: weights 1/2 each.
  const double x = 0.5, here = std::exp(-0.5 * x * x / (a * a));
  // That one's mean is at (a, 0), its covariance floored at 0.01^2 along x: from 0.25 m away, 25 sigma, it is not felt.
  EXPECT_NEAR(grid.score({{x, 0.0}}, {}).value, 0.5 * here, kExactTol);
}

TEST(NdtGrid, ASinglePointHasTheWidthOfTheMinimumStd) {
  const NdtGrid grid({{0.0, 0.0}}, 2.0, 0.3);
  EXPECT_EQ(grid.num_cells(), 1U);
  // Bilinear weight 1 - 0.3 / 1 along x; one sigma away.
  EXPECT_NEAR(grid.score({{0.3, 0.0}}, {}).value, 0.7 * std::exp(-0.5), kExactTol);
  EXPECT_EQ(grid.score({{1e300, -1e300}, {std::nan(""), 0.0}}, {}).value, 0.0) << "beyond the lattice nothing is felt";
}

TEST(NdtGrid, TheGradientEqualsFiniteDifferences) {
  const Points source = test::yard_source_right_of(-100.0);
  const NdtSettings settings;
  for (const NdtGrid& grid : make_ndt(test::yard_target_left_of(100.0), settings)) {
    for (int i = 0; i < 6; ++i) {
      const Pose2 at{kTruth.x + 0.3 * i - 0.7, kTruth.y - 0.2 * i + 0.5, kTruth.yaw + 0.05 * i - 0.1};
      const Eigen::Vector3d gradient = grid.score(source, at).gradient;
      constexpr double kStep = 1e-6;
      for (int k = 0; k < 3; ++k) {
        const auto value = [&](double step) {
          return grid
              .score(source,
                     {at.x + (k == 0 ? step : 0.0), at.y + (k == 1 ? step : 0.0), at.yaw + (k == 2 ? step : 0.0)})
              .value;
        };
        // The score has kinks where a point goes from cell to cell; of 700 points about one in a thousand steps meets
        // one, so a slope may change a little.
        EXPECT_NEAR((value(kStep) - value(-kStep)) / (2.0 * kStep), gradient[k], 1e-5 * (1.0 + gradient.norm()))
            << "cell " << grid.cell_m() << " of " << k;
      }
    }
  }
}

TEST(NdtGrid, TheScoreHasNoJumps) {
  const Points source = test::yard_source_right_of(-100.0);
  const NdtGrid grid(test::yard_target_left_of(100.0), 1.0, 0.15);
  double before = grid.score(source, kTruth).value;
  for (int i = 1; i <= 2000; ++i) {  // 726 points; the steepest slope of a normal 0.15 m wide is 0.61 / 0.15 per meter,
                                     // of a weight 2 per meter
    const double value = grid.score(source, {kTruth.x + 1e-3 * i, kTruth.y, kTruth.yaw}).value;
    EXPECT_LT(std::abs(value - before), 726 * 1e-3 * (0.61 / 0.15 + 2.0));
    before = value;
  }
}

TEST(NdtGrid, TheCurvatureIsNeverNegative) {
  const Points source = test::yard_source_right_of(-100.0);
  const NdtGrid grid(test::yard_target_left_of(100.0), 2.0, 0.3);
  for (int i = 0; i < 20; ++i) {
    const NdtScore score = grid.score(source, {0.4 * i - 4.0, 0.3 * i - 3.0, 0.31 * i});
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(score.curvature);
    EXPECT_GE(axes.eigenvalues().minCoeff(), -1e-9 * axes.eigenvalues().maxCoeff());
  }
}

TEST(NdtGrid, PointsThatAreNotNumbersOrTooFarApartAreRefused) {
  const auto complaint = [](const Points& points) -> std::string {
    try {
      NdtGrid(points, 1.0, 0.1);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(complaint({{0.0, 0.0}, {std::nan(""), 1.0}}), "point (nan, 1): must be finite");
  EXPECT_EQ(complaint({{0.0, 0.0}, {1e9, 1.0}}),
            "ndt: lattice of 2000000002 nodes of 0.5 m along an axis: must be at most 4000");
}

// Positions to 5 cm, for walls sampled every 10 cm with 1 cm of noise.
TEST(AlignNdt, TheBasinIsThreeMetersAndTwentyDegreesWhereAllOverlaps) {
  const Points target = test::yard_target_left_of(100.0), source = test::yard_source_right_of(-100.0);
  EXPECT_GT(overlap(target, source), 0.99);
  EXPECT_EQ(num_found(target, source, 3.0, 20.0 * kDegree), 18);
  EXPECT_LT(num_found(target, source, 6.0, 60.0 * kDegree), 9) << "it ends somewhere";
}

TEST(AlignNdt, TheBasinIsOneMeterAndTenDegreesWhereAThirdOverlapsAndMostlyTwoMeters) {
  const Points target = test::yard_target_left_of(3.0), source = test::yard_source_right_of(-3.0);
  EXPECT_NEAR(overlap(target, source), 0.30, 0.01);
  EXPECT_EQ(num_found(target, source, 1.0, 10.0 * kDegree), 18);
  EXPECT_GE(num_found(target, source, 2.0, 15.0 * kDegree), 15);
}

TEST(AlignNdt, ReportsTheFit) {
  const NdtSettings settings;
  const Points target = test::yard_target_left_of(100.0), source = test::yard_source_right_of(-100.0);
  const auto ndt = make_ndt(target, settings);
  const auto result = align_ndt(ndt, source, {kTruth.x + 0.5, kTruth.y - 0.5, kTruth.yaw + 0.1}, settings);
  ASSERT_TRUE(result);
  EXPECT_THAT(result->T_target_source, Pose2Near(kTruth, 0.01, 0.1 * kDegree));
  EXPECT_TRUE(result->converged);
  // Along a straight wall a cell's points weigh 1 - |u|/h at u from its node: variance h^2/6, and the mean score is 2
  // int_0^1 (1 - t) exp(-3 t^2) dt = 0.692.
  EXPECT_NEAR(result->score, 0.692, 0.03);
  Points stray = source;
  for (const auto& p : source) stray.push_back(p + Eigen::Vector2d(100.0, 0.0));
  NdtSettings all;
  all.max_points = 10000;
  const auto half = align_ndt(ndt, stray, kTruth, all);
  ASSERT_TRUE(half);
  EXPECT_NEAR(half->score, 0.5 * align_ndt(ndt, source, kTruth, all)->score, 1e-6)
      << "points without a partner count nothing";
}

TEST(AlignNdt, ACorridorDoesNotConstrainTheLongitudinalPosition) {
  RoomWorld corridor;
  corridor.add_wall(-40.0, -1.0, 40.0, -1.0).add_wall(-40.0, 1.0, 40.0, 1.0);
  const auto middle = [](const Eigen::Vector2d& p) { return std::abs(p.x()) < 8.0; };
  const Points target = sample_walls(corridor, {}), source = sample_walls(corridor, {}, {.phase = 0.5}, middle);
  const NdtSettings settings;
  const auto result = align_ndt(make_ndt(target, settings), source, {0.4, 0.2, 0.03}, settings);
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->T_target_source.y, 0.0, 0.005);
  EXPECT_NEAR(result->T_target_source.yaw, 0.0, 0.1 * kDegree);
  EXPECT_LT(result->information(0, 0), 0.01 * result->information(1, 1));
}

TEST(AlignNdt, WithoutPointsOrOverlapThereIsNoResult) {
  const NdtSettings settings;
  const auto ndt = make_ndt(test::yard_target_left_of(100.0), settings);
  EXPECT_FALSE(align_ndt(ndt, {}, {}, settings));
  EXPECT_FALSE(align_ndt(make_ndt({}, settings), {{0.0, 0.0}}, {}, settings));
  EXPECT_FALSE(align_ndt(ndt, test::yard_source_right_of(0.0), {500.0, 0.0, 0.0}, settings));
}

TEST(NdtSettings, RefusesANonsenseSettingByName) {
  NdtSettings settings;
  settings.cells_m = {4.0, 0.0};
  try {
    validate(settings, "ndt");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "ndt.cells_m.1 = 0: must be in [0.05, 100]");
  }
}

TEST(Subsample, KeepsEveryThirdOfThree) {
  const Points points{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}};
  EXPECT_EQ(subsample(points, 2), (Points{{0, 0}, {3, 0}}));
  EXPECT_EQ(subsample(points, 6), points);
}

}  // namespace
}  // namespace patrol::slam::ndt_test
