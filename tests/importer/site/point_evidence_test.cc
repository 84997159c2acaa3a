#include "importer/site/points/point_evidence.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/importer/site/scanned_room.h"

namespace patrol::importer::point_evidence_test {
namespace {

// Beams 0.6 degrees apart, 42 mm on the wall at x = 4 m.
const Panorama& empty_room() {
  static const Panorama kScan(ScannedRoom{}.scan("s", {0.0, 0.0, 1.5}));
  return kScan;
}

/// Point of an upright surface that faces the scanner.
SeenPoint point_at(double x, double spacing_m = 0.04, double width_m = 0.5) {
  return {.position = {x, 0.5, 1.5},
          .normal = {-1.0, 0.0, 0.0},
          .spacing_m = spacing_m,
          .width_m = width_m,
          .footprint_m = spacing_m};
}

TEST(PointEvidence, PointInFreeSpaceIsFreeAndPointBehindAWallIsUnknown) {
  EXPECT_EQ(evidence_of(empty_room(), point_at(2.0)), Evidence::kFree);
  EXPECT_EQ(evidence_of(empty_room(), point_at(5.0)), Evidence::kNone);
}

TEST(PointEvidence, SurfaceNarrowerThanTheDistanceBetweenBeamsIsUnknown) {
  const double footprint_m = empty_room().step_rad() * std::hypot(2.0, 0.5);
  EXPECT_EQ(evidence_of(empty_room(), point_at(2.0, 0.04, 1.10 * footprint_m)), Evidence::kNone);
  EXPECT_EQ(evidence_of(empty_room(), point_at(2.0, 0.04, 1.20 * footprint_m)), Evidence::kFree);
}

TEST(PointEvidence, SurfaceAlongTheBeamsIsUnknown) {
  SeenPoint along = point_at(2.0);
  along.normal = Eigen::Vector3d(-0.5, 2.0, 0.0).normalized();
  EXPECT_EQ(evidence_of(empty_room(), along), Evidence::kNone);
}

TEST(PointEvidence, PointOnAWallIsCoveredIfTheBeamsAreThreeQuartersAsFarApartAndElseObserved) {
  const double range_m = std::hypot(4.0, 0.5), spacing_m = spacing_on_surface_m(range_m, empty_room().step_rad(), 0.99);
  EXPECT_EQ(evidence_of(empty_room(), point_at(4.0, spacing_m / 0.70)), Evidence::kCovered);
  EXPECT_EQ(evidence_of(empty_room(), point_at(4.0, spacing_m)), Evidence::kObserved);
}

TEST(PointEvidence, OtherSideOfAWallIsObservedOnly) {
  SeenPoint behind = point_at(4.0, 0.2);
  behind.normal = {1.0, 0.0, 0.0};
  EXPECT_EQ(evidence_of(empty_room(), behind), Evidence::kObserved);
}

TEST(PointEvidence, PointBelowTheRowsIsUnknown) {
  SeenPoint below = point_at(0.0);
  below.position = {0.0, 0.1, 0.2};
  EXPECT_EQ(evidence_of(empty_room(), below), Evidence::kNone);
}

TEST(PointEvidence, SpacingAtSixtyDegreesIsThatAcrossTheBeamsTimesTheRootOfTwo) {
  EXPECT_NEAR(spacing_on_surface_m(10.0, 0.01, 1.0), 0.1, 1e-12);
  EXPECT_NEAR(spacing_on_surface_m(10.0, 0.01, 0.5), 0.1 * std::sqrt(2.0), 1e-12);
}

}  // namespace
}  // namespace patrol::importer::point_evidence_test
