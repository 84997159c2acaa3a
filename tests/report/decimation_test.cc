#include "report/decimation.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace patrol::report::decimation_test {
namespace {

using Points = std::vector<Eigen::Vector2d>;

Points line_of(int num_points) {
  Points points;
  for (int i = 0; i < num_points; ++i) points.emplace_back(0.1 * i, 1.0 + 0.001 * i);
  return points;
}

TEST(Decimated, KeepsTheOnePeakAndTheOneDipOfALongCurve) {
  Points curve = line_of(100000);
  curve[31415].y() = 1e3;
  curve[92653].y() = -1e3;
  const Points kept = decimate(curve, 600);
  EXPECT_LE(kept.size(), 2u * 600u + 2u);
  EXPECT_NE(std::find(kept.begin(), kept.end(), curve[31415]), kept.end());
  EXPECT_NE(std::find(kept.begin(), kept.end(), curve[92653]), kept.end());
}

TEST(Decimated, KeepsBothEndsAndTheOrder) {
  const Points curve = line_of(5001), kept = decimate(curve, 100);
  EXPECT_EQ(kept.front(), curve.front());
  EXPECT_EQ(kept.back(), curve.back());
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end(), [](const auto& a, const auto& b) { return a.x() < b.x(); }));
}

TEST(Decimated, HoldsNoPointThatTheCurveDoesNotHave) {
  const Points curve = line_of(5001);
  for (const Eigen::Vector2d& point : decimate(curve, 100))
    EXPECT_NE(std::find(curve.begin(), curve.end(), point), curve.end());
}

TEST(Decimated, LeavesAShortCurveAsItIs) {
  EXPECT_EQ(decimate(line_of(200), 100), line_of(200));
  EXPECT_TRUE(decimate({}, 100).empty());
}

TEST(Simplified, StaysWithinItsToleranceOfEveryPointOfACircle) {
  constexpr double kTolerance = 0.01;
  Points circle;
  for (int i = 0; i <= 3600; ++i)
    circle.emplace_back(5.0 * std::cos(i * M_PI / 1800.0), 5.0 * std::sin(i * M_PI / 1800.0));
  const Points kept = simplify_path(circle, kTolerance);
  // A chord that stays within h of a circle of radius r is sqrt(8 r h) = 0.63 m long: 50 of them.
  EXPECT_GE(kept.size(), 50u);
  EXPECT_LE(kept.size(), 130u);
  for (std::size_t i = 1; i < kept.size(); ++i)
    EXPECT_GE((0.5 * (kept[i] + kept[i - 1])).norm(), 5.0 - kTolerance - 1e-9);
}

TEST(Simplified, KeepsTheCornersOfASquareAndNothingElse) {
  Points square;
  for (const Eigen::Vector2d& side :
       {Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1), Eigen::Vector2d(-1, 0), Eigen::Vector2d(0, -1)}) {
    for (int i = 0; i < 10; ++i) square.push_back((square.empty() ? Eigen::Vector2d(0, 0) : square.back()) + side);
  }
  EXPECT_EQ(simplify_path(square, 0.01), (Points{{1, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}}));
}

TEST(Simplified, LeavesStandingStillAndShortPathsAlone) {
  EXPECT_EQ(simplify_path(Points(100, {3, 4}), 0.01), (Points{{3, 4}, {3, 4}}));
  EXPECT_EQ(simplify_path({{1, 2}}, 0.01), (Points{{1, 2}}));
  EXPECT_TRUE(simplify_path({}, 0.01).empty());
}

}  // namespace
}  // namespace patrol::report::decimation_test
