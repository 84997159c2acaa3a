#include "slam/graph/branch_and_bound.h"

#include <cmath>

#include <gtest/gtest.h>

#include "slam/match_points.h"
#include "slam/scan_integration.h"
#include "tests/slam/graph/office_world.h"
#include "tests/support/pose_near.h"

namespace patrol::slam::branch_and_bound_test {
namespace {

const Pose2 kMapped{8.0, 4.2, 0.0}, kSeen{9.3, 4.6, 0.5};

const LikelihoodPyramid& office_pyramid() {
  static const LikelihoodPyramid pyramid = [] {
    GridMap map(0.05, 200.0);
    const test::RoomWorld office = test::make_office();
    for (double x = 0.0; x < 6.0; x += 0.5) {
      const Pose2 pose = kMapped * Pose2{x, 0.0, 0.0};
      integrate_scan(office.scan(pose, test::kOldLidar), pose, {}, map);
    }
    return LikelihoodPyramid(map, 0.1, 6);
  }();
  return pyramid;
}

std::vector<Eigen::Vector2d> points_seen() {
  std::vector<Eigen::Vector2d> points;
  for (const MatchPoint& point : downsample_scan(test::make_office().scan(kSeen, test::kOldLidar), 0.1, 100))
    points.push_back(point.p_body);
  return points;
}

double score_of(const Pose2& pose, const Eigen::Vector2d& corner, const Cell& shift) {
  double sum = 0.0;
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(pose.yaw).toRotationMatrix();
  for (const Eigen::Vector2d& point : points_seen()) {
    const Eigen::Vector2d cell = (R * point + corner) / 0.1;
    sum += office_pyramid().value(0, static_cast<int>(std::floor(cell.x())) + shift.col,
                                  static_cast<int>(std::floor(cell.y())) + shift.row);
  }
  return sum / (LikelihoodPyramid::kOnSurface * static_cast<double>(points_seen().size()));
}

TEST(SearchWindow, FindsThePoseToACellAndTheStepOfAngle) {
  const auto found = search_window(office_pyramid(), points_seen(),
                                   {.T_map_center = {7.5, 5.2, 0.2}, .half_width_m = 3.0, .half_angle_rad = 0.6}, 0.3);
  ASSERT_TRUE(found);
  EXPECT_THAT(found->T_map_points, test::Pose2Near(kSeen, 0.1, 0.02));
  EXPECT_GT(found->score, 0.6);
}

// Branch and bound may leave out only what cannot win: all 21 x 21 shifts under the angle that was found.
TEST(SearchWindow, NoShiftOfAllFourHundredAndFortyOneScoresHigher) {
  const SearchWindow window{.T_map_center = {9.0, 4.5, 0.45}, .half_width_m = 1.0, .half_angle_rad = 0.1};
  const auto found = search_window(office_pyramid(), points_seen(), window, 0.0);
  ASSERT_TRUE(found);
  const Eigen::Vector2d corner = window.T_map_center.position() - Eigen::Vector2d(1.0, 1.0);
  double best = -1.0;
  for (int row = 0; row <= 20; ++row) {
    for (int col = 0; col <= 20; ++col) best = std::max(best, score_of(found->T_map_points, corner, {col, row}));
  }
  EXPECT_DOUBLE_EQ(found->score, best);
}

// Windows at the edges of the map, with points inside and outside of it.
TEST(SearchWindow, NoShiftScoresHigherInWindowsAcrossTheEdgesOfTheMap) {
  for (const Eigen::Vector2d& center : {Eigen::Vector2d(-4.0, 1.0), Eigen::Vector2d(22.0, 5.0),
                                        Eigen::Vector2d(9.0, -7.0), Eigen::Vector2d(8.0, 12.0)}) {
    const SearchWindow window{
        .T_map_center = {center.x(), center.y(), 0.5}, .half_width_m = 1.5, .half_angle_rad = 0.0};
    const auto found = search_window(office_pyramid(), points_seen(), window, -1.0);
    ASSERT_TRUE(found);
    double best = -1.0;
    for (int row = 0; row <= 30; ++row) {
      for (int col = 0; col <= 30; ++col)
        best = std::max(best, score_of(found->T_map_points, center - Eigen::Vector2d(1.5, 1.5), {col, row}));
    }
    EXPECT_DOUBLE_EQ(found->score, best) << center.transpose();
  }
}

TEST(SearchWindow, ExcludedPosesAreNotFoundAgainAndTheSecondBestScoresLess) {
  const SearchWindow window{.T_map_center = kSeen, .half_width_m = 3.0, .half_angle_rad = 0.3};
  const auto best = search_window(office_pyramid(), points_seen(), window, 0.0);
  ASSERT_TRUE(best);
  const SearchExclusion exclusion{.T_map_center = best->T_map_points, .radius_m = 0.8, .angle_rad = 1.0};
  const auto rival = search_window(office_pyramid(), points_seen(), window, 0.0, std::span(&exclusion, 1));
  ASSERT_TRUE(rival);
  EXPECT_GT((rival->T_map_points.position() - best->T_map_points.position()).norm(), 0.8);
  EXPECT_LT(rival->score, 0.8 * best->score);
}

TEST(SearchWindow, FindsNothingAboveAScoreThatNoPoseReachesNorWithoutPoints) {
  EXPECT_FALSE(search_window(office_pyramid(), points_seen(),
                             {.T_map_center = kSeen, .half_width_m = 1.0, .half_angle_rad = 0.1}, 0.999));
  EXPECT_FALSE(search_window(office_pyramid(), {}, {.T_map_center = kSeen}, 0.0));
}

}  // namespace
}  // namespace patrol::slam::branch_and_bound_test
