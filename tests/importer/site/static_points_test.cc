#include "importer/site/points/static_points.h"

#include <gtest/gtest.h>

#include "importer/site/points/near_gaps.h"
#include "tests/importer/site/scanned_room.h"

namespace patrol::importer {
namespace {

constexpr double kMinRange_m = 0.6;

/// Scan without the returns for which `is_lost` holds.
template <typename Lost>
Panorama panorama_without(const ScannedRoom& room, const Eigen::Vector3d& origin, Lost is_lost) {
  io::StationScan scan = room.scan("s", origin);
  std::erase_if(scan.points, [&](const ScannerPoint& point) {
    return is_lost(Eigen::Vector3d(double{point.x}, double{point.y}, double{point.z}) - origin);
  });
  return Panorama(scan);
}

Panorama panorama_of(const ScannedRoom& room, const Eigen::Vector3d& origin) {
  return panorama_without(room, origin, [](const Eigen::Vector3d& offset) { return offset.norm() < kMinRange_m; });
}

/// Fraction of the pixels with a point in the box that have the state.
double fraction_with(const Panorama& scan, const Eigen::AlignedBox3d& box, PixelState state) {
  std::size_t num_points = 0, num_with = 0;
  for (int col = 0; col < scan.columns(); ++col) {
    for (int row = 0; row < scan.rows(); ++row) {
      if (scan.range_m({col, row}) <= 0.0f || !box.contains(scan.point({col, row}))) continue;
      ++num_points;
      num_with += scan.has({col, row}, state) ? 1 : 0;
    }
  }
  return num_points < 30 ? -1.0 : static_cast<double>(num_with) / static_cast<double>(num_points);
}

std::size_t num_blocked(Panorama scan) {
  mark_near_gaps(scan);
  std::size_t count = 0;
  for (int col = 0; col < scan.columns(); ++col) {
    for (int row = 0; row < scan.rows(); ++row) count += scan.has({col, row}, kPixelBlocked) ? 1 : 0;
  }
  return count;
}

const Eigen::Vector3d kOpen(-3.0, 0.0, 1.7), kAtThePlate(2.25, 0.0, 1.7);
const Eigen::AlignedBox3d kPost(Eigen::Vector3d(-0.2, -0.2, 0.0), Eigen::Vector3d(0.2, 0.2, 1.4));

ScannedRoom room_with_plate() {
  // The plate is 0.25 m from the second scanner: no returns from the 0.55 m around the foot of the perpendicular.
  return {.objects = {kPost, Eigen::AlignedBox3d(Eigen::Vector3d(1.9, -1.0, 0.0), Eigen::Vector3d(2.0, 1.0, 2.9))}};
}

TEST(StaticPoints, ObjectBehindASurfaceCloserThanTheMinimumRangeStays) {
  std::vector<Panorama> scans = {panorama_of(room_with_plate(), kOpen), panorama_of(room_with_plate(), kAtThePlate)};
  find_static_points(scans, [](std::size_t) {});
  Eigen::AlignedBox3d box = kPost;
  box.min().array() -= 0.02;
  box.max().array() += 0.02;
  EXPECT_EQ(fraction_with(scans[0], box, kPixelMoving), 0.0);
}

TEST(StaticPoints, ObjectThatAScannerWithoutThePlateLooksThroughIsMoving) {
  std::vector<Panorama> scans = {panorama_of(room_with_plate(), kOpen), panorama_of(ScannedRoom{}, kAtThePlate)};
  find_static_points(scans, [](std::size_t) {});
  Eigen::AlignedBox3d box = kPost;
  box.min() += Eigen::Vector3d(-0.02, -0.02, 0.03);
  EXPECT_GT(fraction_with(scans[0], box, kPixelMoving), 0.97);
}

TEST(StaticPoints, FootOfARemovedPostIsRemovedDownTo3Centimeters) {
  ScannedRoom with;
  with.objects = {kPost};
  const Eigen::Vector3d second(1.2, 2.0, 1.7), third(1.2, -2.0, 1.7);
  std::vector<Panorama> scans = {panorama_of(with, kOpen), panorama_of(ScannedRoom{}, second),
                                 panorama_of(ScannedRoom{}, third)};
  find_static_points(scans, [](std::size_t) {});
  // The side toward the first scanner: from 2.8 m away its rows are 3 cm apart.
  const Eigen::AlignedBox3d foot(Eigen::Vector3d(-0.22, -0.18, 0.03), Eigen::Vector3d(-0.18, 0.18, 0.2));
  EXPECT_GT(fraction_with(scans[0], foot, kPixelMoving), 0.97);
  const Eigen::AlignedBox3d floor(Eigen::Vector3d(-1.0, -0.5, -0.01), Eigen::Vector3d(-0.3, 0.5, 0.005));
  EXPECT_EQ(fraction_with(scans[0], floor, kPixelMoving), 0.0);
}

TEST(StaticPoints, BarTooNarrowToBeLookedThroughIsRemovedWithTheObjectNextToIt) {
  ScannedRoom with;
  // The bar is 2.5 cm wide. The beams of the second scanner are 3 cm apart there.
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-0.4, -0.4, 0.0), Eigen::Vector3d(0.4, 0.4, 1.4)),
      bar(Eigen::Vector3d(-0.1, 0.9, 0.4), Eigen::Vector3d(-0.075, 0.925, 1.4));
  const Eigen::Vector3d first(-2.0, -1.0, 1.7), second(2.0, 2.5, 1.7);
  Eigen::AlignedBox3d around = bar;
  around.min().array() -= 0.02;
  around.max().array() += 0.02;
  const auto removed = [&](const std::vector<Eigen::AlignedBox3d>& objects) {
    with.objects = objects;
    std::vector<Panorama> scans = {panorama_of(with, first), panorama_of(ScannedRoom{}, second)};
    find_static_points(scans, [](std::size_t) {});
    return fraction_with(scans[0], around, kPixelMoving);
  };
  EXPECT_EQ(removed({bar}), 0.0);
  EXPECT_GT(removed({box, bar}), 0.95);
}

TEST(NearGaps, GapAtAPlateIsBlocked) {
  // The returns closer than 0.6 m are within 65.4 degrees of the perpendicular: 2 pi (1 - 0.25 / 0.6) = 3.67 sr, of
  // which less than a quarter is below -60 degrees or next to the plate's top. A pixel has at most 0.6 degrees squared.
  const std::size_t count = num_blocked(panorama_of(room_with_plate(), kAtThePlate));
  const double largest = 3.67 / (to_rad(0.6) * to_rad(0.6));
  EXPECT_GT(static_cast<double>(count), 0.75 * largest);
  EXPECT_LT(static_cast<double>(count), 1.6 * largest);
}

TEST(NearGaps, SkyIsNotBlocked) {
  const auto is_sky = [](const Eigen::Vector3d& offset) { return offset.z() > 0.5; };
  EXPECT_EQ(num_blocked(panorama_without(ScannedRoom{}, {0.1, 0.2, 1.7}, is_sky)), 0U);
}

TEST(NearGaps, GapFromTheSkyTo40DegreesBelowTheHorizonIsBlocked) {
  const auto is_lost = [](const Eigen::Vector3d& offset) {
    const double elevation = std::atan2(offset.z(), offset.head<2>().norm());
    return offset.x() > std::abs(offset.y()) && elevation > to_rad(-40.0) && elevation < to_rad(20.0);
  };
  // A quarter of 600 columns with 60 of 0.6 degrees.
  EXPECT_NEAR(static_cast<double>(num_blocked(panorama_without(ScannedRoom{}, kOpen, is_lost))), 150.0 * 100.0, 400.0);
}

}  // namespace
}  // namespace patrol::importer
