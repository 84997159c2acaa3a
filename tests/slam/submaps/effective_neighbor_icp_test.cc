#include "slam/submaps/effective_neighbor_icp.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "tests/support/pose_near.h"
#include "tests/support/submap_points.h"

namespace patrol::slam::effective_neighbor_icp_test {
namespace {

using test::make_yard, test::Pose2Near, test::RoomWorld, test::sample_walls;
using Points = std::vector<Eigen::Vector2d>;

constexpr double kExactTol = 1e-12;  // algebra

const Pose2 kTruth = test::kYardTarget.inverse() * test::kYardSource;
constexpr double kNoLimit = 1e9;
constexpr IcpSettings kPaper{.min_threshold_m = 0.0, .max_threshold_m = kNoLimit, .point_to_line = false};
constexpr IcpSettings kFromAfar{.max_threshold_m = kNoLimit};

/// Errors of 12 starts all around, 0.3 m and 3 degrees off.
struct Errors {
  double largest_m = 0.0, largest_rad = 0.0, smallest_m = 1e9;
  int num_converged = 0;
};
Errors errors_of(const Points& target, const Points& source, const IcpSettings& settings) {
  const IcpPoints prepared(target, settings), laid(source, settings);
  Errors errors;
  for (int i = 0; i < 12; ++i) {
    const double direction = 60.0 * kDegree * (i % 6), turn = i < 6 ? 3.0 * kDegree : -3.0 * kDegree;
    const Pose2 start{kTruth.x + 0.3 * std::cos(direction), kTruth.y + 0.3 * std::sin(direction), kTruth.yaw + turn};
    const auto result = align_icp(prepared, laid, start, settings);
    if (!result) continue;
    const Pose2 T_error = kTruth.inverse() * result->T_target_source;
    errors.largest_m = std::max(errors.largest_m, T_error.position().norm());
    errors.smallest_m = std::min(errors.smallest_m, T_error.position().norm());
    errors.largest_rad = std::max(errors.largest_rad, std::abs(T_error.yaw));
    errors.num_converged += result->converged ? 1 : 0;
  }
  return errors;
}

// 10 pairs: six of 0.1 ... 0.6, four of 3, 5, 7, 9.1. Chord 0.1 + (k - 1); it is 5.1 at the sixth: 4.5 above it; 6.1 at
// the seventh: 3.1 above.
TEST(EffectiveThreshold, IsTheDistanceFarthestBelowTheChord) {
  EXPECT_EQ(effective_threshold({0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 3.0, 5.0, 7.0, 9.1}), 0.6);
}

// a_k = (k / 100)^2 lies k / 100 - (k / 100)^2 below the chord: most in the middle, at 0.25.
TEST(EffectiveThreshold, OfAnUpwardBentCurveIsThePaperRule) {
  std::vector<double> distances;
  for (int k = 0; k <= 100; ++k) distances.push_back(k * k / 1e4);
  EXPECT_EQ(effective_threshold(distances), 0.25);
  // Eq. 8 and its sentence as printed: the first k with D_k < D_(k-1), a_(k-1).
  for (std::size_t k = 1; k < distances.size(); ++k) {
    const auto departure = [&](std::size_t i) {
      return distances.back() * static_cast<double>(i) / 100.0 - distances[i];
    };
    if (departure(k) >= departure(k - 1)) continue;
    EXPECT_EQ(distances[k - 1], 0.25);
    break;
  }
}

TEST(EffectiveThreshold, KeepsAllWhereNothingBends) {
  EXPECT_EQ(effective_threshold({0.5}), 0.5);
  EXPECT_EQ(effective_threshold({0.0, 0.0, 0.0}), 0.0);
  EXPECT_EQ(effective_threshold({1.0, 2.0, 3.0}), 3.0);
  EXPECT_EQ(effective_threshold({1.0, 2.9, 3.0}), 3.0) << "above the chord";
}

TEST(AlignIcp, RecoversAMotionToANanometerWhereEveryPointHasItsPartner) {
  const Points source = test::yard_source_right_of(-100.0);
  Points target;
  for (const auto& p : source) target.push_back(kTruth * p);
  const Pose2 start{kTruth.x + 0.02, kTruth.y - 0.03, kTruth.yaw + 0.2 * kDegree};
  for (const IcpSettings& settings : {IcpSettings{}, kPaper}) {
    const auto result = align_icp(IcpPoints(target, settings), IcpPoints(source, settings), start, settings);
    ASSERT_TRUE(result);
    EXPECT_THAT(result->T_target_source, Pose2Near(kTruth, 1e-9, 1e-9));
    EXPECT_TRUE(result->converged);
    EXPECT_LT(result->rms_m, 1e-9);
  }
}

// Where the target ends, the source's farther points pull plain ICP away by meters; the effective neighbors stay within
// a decimeter as the paper has them, and within 2 cm with the lines.
struct PartOverlap {
  double share, target_left_of_m;
};
class PartlyOverlapping : public ::testing::TestWithParam<PartOverlap> {};

TEST_P(PartlyOverlapping, PlainIcpIsMetersOffAndEffectiveNeighborsAreNot) {
  const Points target = test::yard_target_left_of(GetParam().target_left_of_m),
               source = test::yard_source_right_of(-3.0);
  const auto has_partner = [&](const auto& p) {
    return std::ranges::any_of(target, [&](const auto& q) { return (kTruth * p - q).norm() < 0.15; });
  };
  ASSERT_NEAR(static_cast<double>(std::ranges::count_if(source, has_partner)) / static_cast<double>(source.size()),
              GetParam().share, 0.02);

  const Errors plain = errors_of(
      target, source, {.use_effective_neighbors = false, .max_threshold_m = kNoLimit, .point_to_line = false});
  EXPECT_GT(plain.smallest_m, 3.0);
  const Errors paper = errors_of(target, source, kPaper);
  EXPECT_LT(paper.largest_m, 0.12);
  const Errors ours = errors_of(target, source, kFromAfar);
  EXPECT_LT(ours.largest_m, 0.02);
  EXPECT_LT(ours.largest_rad, 0.3 * kDegree);
  EXPECT_EQ(ours.num_converged, 12);
  RecordProperty("plain_smallest_error_m", std::to_string(plain.smallest_m));
  RecordProperty("paper_largest_error_m", std::to_string(paper.largest_m));
  RecordProperty("with_lines_largest_error_m", std::to_string(ours.largest_m));
}

INSTANTIATE_TEST_SUITE_P(By, PartlyOverlapping,
                         ::testing::Values(PartOverlap{0.52, 6.0}, PartOverlap{0.45, 5.0}, PartOverlap{0.35, 4.0},
                                           PartOverlap{0.30, 3.0}),
                         [](const auto& run) {
                           return std::to_string(std::lround(100.0 * run.param.share)) + "Percent";
                         });

TEST(AlignIcp, WithoutMinThresholdOnlyTheBestPairsAreUsed) {
  const Points target = test::yard_target_left_of(100.0), source = test::yard_source_right_of(-100.0);
  EXPECT_GT(errors_of(target, source, kPaper).largest_m, 0.1);
  EXPECT_LT(errors_of(target, source, kFromAfar).largest_m, 0.005);
}

TEST(AlignIcp, ReportsNumberAndDistanceOfPairs) {
  const Points target = test::yard_target_left_of(4.0), source = test::yard_source_right_of(-3.0);
  const IcpSettings settings;
  const auto result = align_icp(IcpPoints(target, settings), IcpPoints(source, settings), kTruth, settings);
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->num_pairs, 0.35 * static_cast<double>(source.size()), 5.0);
  EXPECT_LE(result->threshold_m, 0.2);
  // Points 10 cm apart on a wall, the others 5 cm on: distances up to 5 cm; with 1 cm of noise in each.
  EXPECT_LT(result->rms_m, 0.06);
}

TEST(AlignIcp, ACorridorConstrainsLateralPositionAndHeadingOnly) {
  RoomWorld corridor;
  corridor.add_wall(-40.0, -1.0, 40.0, -1.0).add_wall(-40.0, 1.0, 40.0, 1.0);
  const Points target = sample_walls(corridor, {}, {.std_m = 0.01, .seed = 1});
  const Points source = sample_walls(corridor, {}, {.phase = 0.5, .std_m = 0.01, .seed = 2},
                                     [](const auto& p) { return std::abs(p.x()) < 8.0; });
  const IcpSettings settings;
  const auto result = align_icp(IcpPoints(target, settings), IcpPoints(source, settings), {0.4, 0.1, 0.01}, settings);
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->T_target_source.y, 0.0, 0.005);
  EXPECT_NEAR(result->T_target_source.yaw, 0.0, 0.1 * kDegree);
  EXPECT_LT(result->information(0, 0), 0.01 * result->information(1, 1));
  // 320 pairs of sigma 3 cm, each across.
  EXPECT_NEAR(result->information(1, 1), 320.0 / (0.03 * 0.03), 0.1 * 320.0 / (0.03 * 0.03));
}

// One face of a wall is 0.25 m behind the other; a cross wall with a face to the east holds the pair along.
TEST(AlignIcp, OppositeFacesOfAWallAreNotAligned) {
  const auto face = [](double y, double x0, double x1) {
    Points points;
    for (double x = x0; x < x1; x += 0.1) points.emplace_back(x, y);
    return points;
  };
  const auto facing = [](const Points& points, double y) {
    return std::vector<Eigen::Vector2d>(points.size(), Eigen::Vector2d(0.0, y));
  };
  const Points south = face(0.0, 0.0, 8.0), north = face(0.25, 0.0, 8.0);
  const IcpSettings settings;
  const auto blind = align_icp(IcpPoints(south, settings), IcpPoints(north, settings), {}, settings);
  ASSERT_TRUE(blind);
  EXPECT_NEAR(blind->T_target_source.y, -0.25, 0.01);  // one face taken for the other
  EXPECT_FALSE(align_icp(IcpPoints(south, settings, facing(south, -1.0)),
                         IcpPoints(north, settings, facing(north, 1.0)), {}, settings));

  Points both = south;
  both.insert(both.end(), north.begin(), north.end());
  std::vector<Eigen::Vector2d> sides = facing(south, -1.0);
  for (std::size_t i = 0; i < north.size(); ++i) sides.emplace_back(0.0, 1.0);
  const auto observed = align_icp(IcpPoints(both, settings, sides), IcpPoints(north, settings, facing(north, 1.0)),
                                  {0.0, -0.2, 0.0}, settings);
  ASSERT_TRUE(observed);
  EXPECT_NEAR(observed->T_target_source.y, 0.0, 0.01);  // though the other face was nearer
}

TEST(AlignIcp, WithoutEnoughPointsThereIsNoMatch) {
  const IcpSettings settings;
  const Points points = test::yard_source_right_of(-100.0);
  const IcpPoints none({}, settings), all(points, settings), nine(Points(points.begin(), points.begin() + 9), settings);
  EXPECT_FALSE(align_icp(none, all, {}, settings));
  EXPECT_FALSE(align_icp(all, none, {}, settings));
  EXPECT_FALSE(align_icp(all, nine, {}, settings));
  EXPECT_THROW(IcpPoints({{0.0, std::nan("")}}, settings), InputError);
}

}  // namespace
}  // namespace patrol::slam::effective_neighbor_icp_test
