#include "plan/perception/footprint.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"

namespace patrol::plan::footprint_test {
namespace {

constexpr double kExactTol = 1e-12;

std::vector<Eigen::Vector2d> make_box(double x_min, double x_max, double y_min, double y_max) {
  return {{x_min, y_min}, {x_max, y_min}, {x_max, y_max}, {x_min, y_max}};
}

/// Corners of an ellipse about the origin, at random angles: convex and counter-clockwise.
std::vector<Eigen::Vector2d> make_random_polygon(std::uint64_t seed) {
  const RandomStream stream(seed, "test/polygon");
  const double half_length = 0.2 + 0.6 * stream.uniform(0), half_width = 0.1 + 0.4 * stream.uniform(1);
  const Eigen::Vector2d offset(0.05 * stream.normal(2), 0.02 * stream.normal(3));
  const int corners = 5 + static_cast<int>(6.0 * stream.uniform(4));
  std::vector<Eigen::Vector2d> polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle =
        2.0 * std::numbers::pi * (i + 0.4 * stream.uniform(5, static_cast<std::uint64_t>(i))) / corners;
    polygon.emplace_back(offset + Eigen::Vector2d(half_length * std::cos(angle), half_width * std::sin(angle)));
  }
  return polygon;
}

bool is_inside(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& p) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d edge = polygon[(i + 1) % polygon.size()] - polygon[i], to_p = p - polygon[i];
    if (edge.x() * to_p.y() - edge.y() * to_p.x() < 0.0) return false;
  }
  return true;
}

double distance_outside_discs(const Footprint& footprint, const Eigen::Vector2d& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Disc& disc : footprint.discs()) nearest = std::min(nearest, (p - disc.center_m).norm() - disc.radius_m);
  return nearest;
}

// Points spread over a square around each polygon: none in the polygon may be outside of all discs.
TEST(Footprint, DiscsCoverEveryPointOfTwoHundredPolygons) {
  int num_inside = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const Footprint footprint(make_random_polygon(seed), 1 + static_cast<int>(seed % 3));
    for (const Eigen::Vector2d& corner : footprint.polygon_m()) {
      ASSERT_LE(distance_outside_discs(footprint, corner), kExactTol) << "seed " << seed;
    }
    const RandomStream stream(seed, "test/points");
    for (std::uint64_t i = 0; i < 500; ++i) {
      const Eigen::Vector2d p(2.0 * stream.uniform(i, 0) - 1.0, 1.2 * stream.uniform(i, 1) - 0.6);
      if (!is_inside(footprint.polygon_m(), p)) continue;
      ++num_inside;
      ASSERT_LE(distance_outside_discs(footprint, p), kExactTol) << "seed " << seed << " at " << p.transpose();
    }
  }
  EXPECT_GT(num_inside, 10000);
}

// Over an end they stick out by hypot(piece, width) / 2 - piece / 2 < width / 2.
TEST(Footprint, DiscsStickOutSidewaysByNoMoreThanAskedAndOverTheEndsByHalfTheWidth) {
  for (const double excess_m : {0.005, 0.03, 0.2}) {
    const Footprint footprint(make_box(-0.5, 0.4, -0.15, 0.15), 1, excess_m);
    for (const Disc& disc : footprint.discs()) {
      EXPECT_LE(disc.radius_m, 0.15 + excess_m + kExactTol);
      EXPECT_GE(disc.center_m.x() - disc.radius_m, -0.5 - 0.15);
      EXPECT_LE(disc.center_m.x() + disc.radius_m, 0.4 + 0.15);
    }
  }
}

// 0.8 by 0.3 m cut in four: pieces of 0.2 m, each in a disc of radius hypot(0.1, 0.15) = 0.1803 m, which
// sticks out by 0.0303 m. Three pieces would stick out by hypot(0.1333, 0.15) - 0.15 = 0.0507 m.
TEST(Footprint, FourDiscsOnALongRobot) {
  const Footprint footprint(make_box(-0.4, 0.4, -0.15, 0.15), 1, 0.031);
  ASSERT_EQ(footprint.discs().size(), 4u);
  EXPECT_NEAR(footprint.discs()[0].radius_m, std::hypot(0.1, 0.15), kExactTol);
  EXPECT_NEAR(footprint.discs()[0].center_m.x(), -0.3, kExactTol);
  EXPECT_NEAR(footprint.discs()[3].center_m.x(), 0.3, kExactTol);
  EXPECT_EQ(Footprint(make_box(-0.4, 0.4, -0.15, 0.15), 1, 0.051).discs().size(), 3u);
}

// 1.0 by 0.7 m. One row: pieces of 0.25 m in discs of hypot(0.125, 0.35) = 0.372 m, 0.247 m beyond the ends. Two rows:
// pieces of 0.2 m by 0.35 m in discs of 0.2016 m, 0.102 m beyond them.
TEST(Footprint, ASecondRowTakesFifteenCentimetresOffWhatSticksOutAtTheEnds) {
  const auto excess_m = [](int rows) {
    const Footprint footprint(make_box(-0.5, 0.5, -0.35, 0.35), rows);
    double reach_m = 0.0;
    for (const Disc& disc : footprint.discs()) reach_m = std::max(reach_m, disc.center_m.x() + disc.radius_m);
    return reach_m - 0.5;
  };
  EXPECT_NEAR(excess_m(1), std::hypot(0.125, 0.35) - 0.125, kExactTol);
  EXPECT_NEAR(excess_m(2), std::hypot(0.1, 0.175) - 0.1, kExactTol);
}

TEST(Footprint, AWideRobotHasItsDiscsSideBySide) {
  const Footprint footprint(make_box(-0.1, 0.1, -0.3, 0.3), 1, 0.05);
  ASSERT_GT(footprint.discs().size(), 1u);
  for (const Disc& disc : footprint.discs()) EXPECT_NEAR(disc.center_m.x(), 0.0, kExactTol);
}

TEST(Footprint, RadiiOfABoxOffItsOriginAreTheNearestEdgeAndTheFarthestCorner) {
  const Footprint footprint(make_box(-0.3, 0.5, -0.2, 0.25));
  EXPECT_NEAR(footprint.inscribed_radius_m(), 0.2, kExactTol);
  EXPECT_NEAR(footprint.circumscribed_radius_m(), std::hypot(0.5, 0.25), kExactTol);
}

TEST(Footprint, RefusesWhatIsNoOutline) {
  EXPECT_THROW(Footprint({}), InputError);
  EXPECT_THROW(Footprint({{0.0, 0.0}, {1.0, 0.0}}), InputError);
  std::vector<Eigen::Vector2d> clockwise = make_box(-1.0, 1.0, -1.0, 1.0);
  std::reverse(clockwise.begin(), clockwise.end());
  EXPECT_THROW(Footprint{clockwise}, InputError);
  EXPECT_THROW(Footprint{make_box(0.1, 1.0, -1.0, 1.0)}, InputError);  // the origin is outside
}

}  // namespace
}  // namespace patrol::plan::footprint_test
