#include "importer/site/points/post_fit.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"

namespace patrol::importer {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

PlanBeam beam_from(const Eigen::Vector2d& origin, const Eigen::Vector2d& to) {
  return {.origin_m = origin, .direction = (to - origin).normalized(), .range_m = kInfinite};
}

/// Beams from several places, 0.1 degrees apart, past and onto a shape.
template <typename Range>
std::vector<PlanBeam> beams_onto(const std::vector<Eigen::Vector2d>& origins, Range range) {
  std::vector<PlanBeam> beams;
  for (const Eigen::Vector2d& origin : origins) {
    const double middle = std::atan2(-origin.y(), -origin.x());
    for (int i = -20; i <= 20; ++i) {
      const double angle = middle + to_rad(0.1 * (i + 0.3));
      PlanBeam beam{.origin_m = origin, .direction = {std::cos(angle), std::sin(angle)}};
      beam.range_m = range(beam);
      beam.is_hit = std::isfinite(beam.range_m);
      beams.push_back(beam);
    }
  }
  return beams;
}

double entry_or_infinite(const PlanCrossing& crossing) {
  return crossing.clearance_m < 0.0 ? crossing.entry_m : kInfinite;
}

TEST(PlanCrossing, OfASquareHasDistanceEntryAndChordOfItsSides) {
  const ConvexPolygon square = {{-0.1, -0.1}, {0.1, -0.1}, {0.1, 0.1}, {-0.1, 0.1}};
  const PlanCrossing across = crossing_of(beam_from({-5.0, 0.04}, {5.0, 0.04}), square, Eigen::Vector2d::Zero());
  EXPECT_NEAR(across.clearance_m, -0.06, 1e-12);
  EXPECT_NEAR(across.entry_m, 4.9, 1e-12);
  EXPECT_NEAR(across.chord_m, 0.2, 1e-12);
  const PlanCrossing past = crossing_of(beam_from({-5.0, 0.13}, {5.0, 0.13}), square, Eigen::Vector2d::Zero());
  EXPECT_NEAR(past.clearance_m, 0.03, 1e-12);
  EXPECT_EQ(past.chord_m, 0.0);
}

TEST(PlanCrossing, OfACircleFollowsItsSlopeAtTheHeightOfTheBeam) {
  PlanBeam beam = beam_from({-5.0, 0.0}, {5.0, 0.0});
  beam.height_m = 0.2;
  // The center is 0.2 m x 0.1 = 0.02 m farther to the right and 0.2 m x 0.3 = 0.06 m to the left of the beam.
  const PlanCrossing crossing = crossing_of(beam, {0.0, 0.0}, 0.1, {0.1, 0.3});
  EXPECT_NEAR(crossing.clearance_m, -0.04, 1e-12);
  EXPECT_NEAR(crossing.entry_m, 5.02 - 0.08, 1e-12);
  EXPECT_NEAR(crossing.chord_m, 0.16, 1e-12);
}

TEST(PostFit, CircleSeenFromTwoPlacesIsWithinTwoMillimeters) {
  const Eigen::Vector2d center(0.03, -0.02);
  const double radius_m = 0.08;
  const auto beams = beams_onto({{-6.0, 0.0}, {2.0, -7.0}}, [&](const PlanBeam& beam) {
    return entry_or_infinite(crossing_of(beam, center, radius_m, Eigen::Vector2d::Zero()));
  });
  const ConvexPolygon seen = {{-0.06, -0.1}, {0.06, -0.1}, {-0.06, 0.06}};
  const auto fitted = fit_circle(beams, seen);
  ASSERT_TRUE(fitted);
  EXPECT_LT(fitted->cost, 0.1);
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& corner : fitted->outline_m)
    middle += corner / static_cast<double>(fitted->outline_m.size());
  EXPECT_LT((middle - center).norm(), 0.002);
  EXPECT_NEAR((fitted->outline_m.front() - middle).norm(), radius_m, 0.003);
  EXPECT_GT(cost_of(beams, seen), 0.3);
}

TEST(PostFit, RectangleWithTwoSeenSidesHasItsFourSides) {
  const ConvexPolygon box = {{-0.2, -0.15}, {0.2, -0.15}, {0.2, 0.15}, {-0.2, 0.15}};
  // Both places see the sides at the left and below; their beams past the box bound the others.
  const auto beams = beams_onto({{-9.0, -2.0}, {-2.0, -9.0}}, [&](const PlanBeam& beam) {
    return entry_or_infinite(crossing_of(beam, box, Eigen::Vector2d::Zero()));
  });
  const ConvexPolygon seen = {{-0.2, -0.15}, {0.2, -0.15}, {-0.2, 0.15}};
  const auto fitted = fit_rectangle(beams, seen);
  ASSERT_TRUE(fitted);
  EXPECT_LT(fitted->cost, 0.1);
  EXPECT_NEAR(polygon_area(fitted->outline_m), 0.4 * 0.3, 0.006);
  EXPECT_NEAR(polygon_area(intersect_polygons(fitted->outline_m, box)), 0.4 * 0.3, 0.006);
  const auto circle = fit_circle(beams, seen);
  ASSERT_TRUE(circle);
  EXPECT_GT(circle->cost, 3.0 * fitted->cost);
}

TEST(PostFit, FewerThanEightReturnsFitNothing) {
  auto beams = beams_onto({{-6.0, 0.0}}, [&](const PlanBeam& beam) {
    return entry_or_infinite(crossing_of(beam, {0.0, 0.0}, 0.03, Eigen::Vector2d::Zero()));
  });
  const ConvexPolygon seen = {{-0.03, -0.03}, {0.0, -0.03}, {0.0, 0.03}};
  ASSERT_EQ(std::count_if(beams.begin(), beams.end(), [](const PlanBeam& beam) { return beam.is_hit; }), 6);
  EXPECT_FALSE(fit_circle(beams, seen));
  EXPECT_FALSE(fit_rectangle(beams, seen));
}

}  // namespace
}  // namespace patrol::importer
