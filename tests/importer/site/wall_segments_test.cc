#include "importer/site/wall_segments.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"

namespace patrol::importer::wall_segments_test {
namespace {

/// Plan of 10 x 10 m with its origin at (-5, -5) m, and the hits of its walls.
class SeenWalls {
 public:
  /// Adds hits on a straight face, every 5 mm, seen from 3 m in front of it, with a noise of 1 cm along the beam.
  void add_face(const Eigen::Vector2d& begin, const Eigen::Vector2d& end, const Eigen::Vector2d& normal) {
    const int count = static_cast<int>((end - begin).norm() / 0.005);
    for (int i = 0; i <= count; ++i) {
      const Eigen::Vector2d on_face = begin + (end - begin) * i / count;
      for (const double sideways : {-1.0, 0.0, 1.0}) {
        const Eigen::Vector2d sensor = on_face + 3.0 * normal + sideways * (end - begin).normalized();
        const Eigen::Vector2d hit = on_face + 0.01 * noise_.normal(draws_++) * (on_face - sensor).normalized();
        hits_.emplace_back(hit, sensor);
        plan_.at(plan_.geometry().cell_at(on_face)) = 100;
      }
    }
  }

  WallFitter fitted() const {
    WallFitter fitter(plan_);
    for (const auto& [hit, sensor] : hits_) fitter.add(hit, sensor);
    return fitter;
  }
  OccupancyGrid& plan() { return plan_; }

 private:
  OccupancyGrid plan_{{.resolution_m = 0.05, .width = 200, .height = 200, .origin_m = {-5.0, -5.0}}, 0};
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> hits_;
  RandomStream noise_{1, "hits"};
  std::uint64_t draws_ = 0;
};

double length_m(const WallSegment& segment) { return (segment.end_m - segment.begin_m).norm(); }

// The wall is oblique to the cells, whose half size is 2.5 cm.
TEST(WallFitter, AnObliqueWallOfThreeMetersIsOneSegmentWithin2MillimetersAnd1MilliradianAndFacesItsSensor) {
  const double angle = 0.3;
  const Eigen::Vector2d along(std::cos(angle), std::sin(angle)), normal(-along.y(), along.x());
  const Eigen::Vector2d begin(-1.0, 0.7);
  SeenWalls walls;
  walls.add_face(begin, begin + 3.0 * along, normal);
  const std::vector<WallSegment> segments = walls.fitted().segments();
  const WallSegment& longest = segments.front();
  EXPECT_NEAR(length_m(longest), 3.0, 0.12);
  EXPECT_NEAR(std::abs(longest.normal.dot(normal)), 1.0, 5e-7);
  EXPECT_GT(longest.normal.dot(normal), 0.0);
  EXPECT_NEAR(normal.dot(longest.begin_m - begin), 0.0, 0.002);
  EXPECT_NEAR(normal.dot(longest.end_m - begin), 0.0, 0.002);
  for (const WallSegment& segment : segments) EXPECT_NEAR(normal.dot(segment.begin_m - begin), 0.0, 0.03);
}

TEST(WallFitter, TheTwoFacesOfAWallOf10CentimetersKeepTheirDistanceTo5Millimeters) {
  SeenWalls walls;
  walls.add_face({-2.0, 0.03}, {2.0, 0.03}, {0.0, -1.0});
  walls.add_face({-2.0, 0.13}, {2.0, 0.13}, {0.0, 1.0});
  double below_m = 0.0, above_m = 0.0;
  for (const WallSegment& segment : walls.fitted().segments()) {
    double& covered_m = segment.normal.y() < 0.0 ? below_m : above_m;
    if (length_m(segment) < 0.3) continue;
    covered_m += length_m(segment);
    EXPECT_NEAR(segment.begin_m.y(), segment.normal.y() < 0.0 ? 0.03 : 0.13, 0.005);
  }
  EXPECT_NEAR(below_m, 4.0, 0.3);
  EXPECT_NEAR(above_m, 4.0, 0.3);
}

double min_thickness_m(const WallFitter& fitter) {
  double thickness_m = 1.0;
  for (const WallSegment& segment : fitter.segments()) thickness_m = std::min(thickness_m, segment.thickness_m);
  return thickness_m;
}

TEST(WallFitter, APartitionOf3CentimetersIsAtMostHalfAsThickBehindEachFaceAndAWallSeenFromOneSideHas4Centimeters) {
  SeenWalls partition;
  partition.add_face({-2.0, 0.03}, {2.0, 0.03}, {0.0, -1.0});
  partition.add_face({-2.0, 0.06}, {2.0, 0.06}, {0.0, 1.0});
  int num_long = 0;
  for (const WallSegment& segment : partition.fitted().segments()) {
    EXPECT_LE(segment.thickness_m, 0.017);
    if (length_m(segment) < 0.3) continue;
    ++num_long;
    EXPECT_GE(segment.thickness_m, 0.010);
  }
  EXPECT_GE(num_long, 2);
  SeenWalls one_side;
  one_side.add_face({-2.0, 0.03}, {2.0, 0.03}, {0.0, -1.0});
  EXPECT_EQ(min_thickness_m(one_side.fitted()), 0.04);
}

TEST(WallFitter, ACircleOf2MetersIsCoveredWithin15MillimetersOfItsRadius) {
  SeenWalls walls;
  constexpr int kPieces = 360;
  const auto on_circle = [](int i) {
    const double angle = 2.0 * std::numbers::pi * i / kPieces;
    return Eigen::Vector2d(2.0 * std::cos(angle), 2.0 * std::sin(angle));
  };
  for (int i = 0; i < kPieces; ++i) walls.add_face(on_circle(i), on_circle(i + 1), -0.5 * on_circle(i));
  double covered_m = 0.0;
  for (const WallSegment& segment : walls.fitted().segments()) {
    covered_m += length_m(segment);
    const Eigen::Vector2d middle = 0.5 * (segment.begin_m + segment.end_m);
    EXPECT_NEAR(middle.norm(), 2.0, 0.015);
    EXPECT_LT(segment.normal.dot(middle), 0.0);
  }
  EXPECT_GT(covered_m, 2.0 * std::numbers::pi * 2.0 * 0.95);
}

TEST(WallFitter, ACellWithoutHitsIsUncoveredAndAPlanWithoutWallsIsRefused) {
  SeenWalls walls;
  walls.add_face({-2.0, 0.03}, {2.0, 0.03}, {0.0, 1.0});
  const Cell lone = walls.plan().geometry().cell_at({3.0, 3.0});
  walls.plan().at(lone) = 100;
  const WallFitter fitter = walls.fitted();
  EXPECT_TRUE(fitter.is_uncovered(lone));
  EXPECT_FALSE(fitter.is_uncovered(walls.plan().geometry().cell_at({0.0, 0.03})));
  EXPECT_THROW(WallFitter(OccupancyGrid({.width = 5, .height = 5}, 0)), InputError);
}

}  // namespace
}  // namespace patrol::importer::wall_segments_test
