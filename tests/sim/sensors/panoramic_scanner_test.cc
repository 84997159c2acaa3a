#include "sim/sensors/panoramic_scanner.h"

#include "tests/sim/sensors/panoramic_scans.h"

namespace patrol::sim::panoramic_scanner_test {
namespace {

TEST(PanoramicScanner, ByDefaultA1000By417GridOfTheWholeSphereButForANadirConeOf30Degrees) {
  const SmallWorld world(kRoom);
  PanoramicScannerSettings settings = ideal();
  settings.step_deg = PanoramicScannerSettings{}.step_deg;
  const PanoramicScanner scanner(settings, world.scene, {}, 1);
  EXPECT_EQ(scanner.columns(), 1000);
  EXPECT_EQ(scanner.rows(), 417);
  const PanoramicScan taken = scan(world, settings);
  ASSERT_EQ(taken.points.size(), 417000u);
  double lowest_deg = 90.0, highest_deg = -90.0;
  for (const ScannerPoint& point : taken.points) {
    const Eigen::Vector3d p = position_of(point);
    ASSERT_NEAR(p.norm(), room_range(p.normalized()), 1e-3);
    const double elevation_deg = std::asin(p.normalized().z()) / kDegree;
    lowest_deg = std::min(lowest_deg, elevation_deg), highest_deg = std::max(highest_deg, elevation_deg);
  }
  EXPECT_NEAR(lowest_deg, -60.0, 1e-3);
  EXPECT_NEAR(highest_deg, 89.76, 1e-2);
}

TEST(PanoramicScanner, AScanTakes30SecondsIsStampedAtItsEndAndNoOtherIsBegunMeanwhile) {
  const SmallWorld world(kRoom);
  PanoramicScanner scanner(ideal(), world.scene, {}, 1);
  EXPECT_FALSE(scanner.is_busy());
  scanner.begin(from_seconds(7.0), {});
  for (double now = 7.0; now < 36.5; now += 1.0) {
    EXPECT_TRUE(scanner.is_busy()) << now;
    scanner.begin(from_seconds(now), {});
    scanner.advance(from_seconds(now), from_seconds(now + 1.0), {}, {});
  }
  EXPECT_FALSE(scanner.is_busy());
  const auto scans = scanner.take_scans();
  ASSERT_EQ(scans.size(), 1u);
  EXPECT_EQ(scans[0].stamp, from_seconds(37.0));
  EXPECT_EQ(scans[0].points.size(), 180u * 76u);
}

// The figures of the sheet, in mm: on 90, 10 and 2 %, at 10 and 25 m. The beams meet the wall within 8 degrees of its
// normal.
TEST(PanoramicScanner, RangeNoiseIsThatOfTheSheetToItsLastDigit) {
  const struct {
    double reflectivity, range_m, std_mm;
  } kSheet[] = {{0.9, 10, 0.3}, {0.9, 25, 0.3}, {0.1, 10, 0.4}, {0.1, 25, 0.5}, {0.02, 10, 1.3}, {0.02, 25, 2.0}};
  for (const auto& [reflectivity, range_m, std_mm] : kSheet) {
    const SmallWorld world(box(std::to_string(range_m + 0.5) + " 0 0", "0.5 30 30", reflectivity));
    PanoramicScannerSettings settings = ideal();
    settings.step_deg = 0.36;
    settings.elevation_min_deg = -9.0;
    settings.range_noise_std_m = PanoramicScannerSettings{}.range_noise_std_m;
    settings.gray_noise_std_m = PanoramicScannerSettings{}.gray_noise_std_m;
    const test::Moments errors = range_errors(world, settings, 8.0);
    ASSERT_GT(errors.count, 1500);
    EXPECT_NEAR(1e3 * errors.std(), std_mm, 0.05 + 4.0 * std_mm / std::sqrt(2.0 * errors.count))
        << reflectivity << " at " << range_m;
    EXPECT_NEAR(1e3 * errors.mean(), 0.0, 4.0 * std_mm / std::sqrt(errors.count));
  }
}

// At 60 degrees half the light comes back: sqrt(0.3^2 + (2 x 0.255)^2) = 0.592 mm on 10 % at 10 m.
TEST(PanoramicScanner, ASurfaceMetAt60DegreesHasTheNoiseOfHalfItsLight) {
  const SmallWorld world(box("10 0 0", "0.001 30 30", 0.1, R"(euler="0 0 60")"));
  PanoramicScannerSettings settings = ideal();
  settings.step_deg = 0.18;
  settings.elevation_min_deg = -3.0;
  settings.range_noise_std_m = 0.0003;
  settings.gray_noise_std_m = 0.000255;
  const test::Moments errors = range_errors(world, settings, 2.0);
  ASSERT_GT(errors.count, 350);
  EXPECT_NEAR(1e3 * errors.std(), 0.592, 4.0 * 0.592 / std::sqrt(2.0 * errors.count));
}

TEST(PanoramicScanner, AScansRangesAreAllOffByTheSameWhichIsHalfAMillimetreFromScanToScan) {
  const SmallWorld world(kRoom);
  PanoramicScannerSettings settings = ideal();
  settings.step_deg = 10.0;
  settings.range_offset_std_m = 0.0005;
  PanoramicScanner scanner(settings, world.scene, {}, 1);
  test::Moments offsets;
  for (int i = 0; i < 300; ++i) {
    test::Moments of_scan;
    for (const ScannerPoint& point : next_scan(scanner, settings.duration_s).points) {
      const Eigen::Vector3d p = position_of(point);
      of_scan.add(p.norm() - room_range(p.normalized()));
    }
    EXPECT_LT(of_scan.std(), 1e-5);
    offsets.add(of_scan.mean());
  }
  EXPECT_NEAR(offsets.std(), 0.0005, 4.0 * 0.0005 / std::sqrt(2.0 * 300));
  EXPECT_NEAR(offsets.mean(), 0.0, 4.0 * 0.0005 / std::sqrt(300.0));
}

// On a surface met at 60 degrees the range changes by r tan(60 deg) per radian: azimuth shows on a wall, elevation on a
// ramp.
TEST(PanoramicScanner, AzimuthAndElevationOfABeamAreEachOffBy19ArcSeconds) {
  for (const char* turn : {"0 0 60", "0 60 0"}) {
    const SmallWorld world(box("10 0 0", "0.001 30 30", 1.0, std::string(R"(euler=")") + turn + "\""));
    PanoramicScannerSettings settings = ideal();
    settings.step_deg = 0.09;
    settings.elevation_min_deg = -1.5;
    settings.angle_noise_std_deg = 19.0 / 3600.0;
    const test::Moments errors = range_errors(world, settings, 1.0);
    ASSERT_GT(errors.count, 350);
    const double expected_m = 10.0 * std::tan(60.0 * kDegree) * 19.0 / 3600.0 * kDegree;  // 1.6 mm
    EXPECT_NEAR(errors.std(), expected_m, expected_m * (0.04 + 4.0 / std::sqrt(2.0 * errors.count)))
        << turn;  // within 1 degree: 4 %
  }
}

// 2,000 beams and more, a tenth lost in each scan: a hundredth in both, 20 +- 4.5.
TEST(PanoramicScanner, AReferenceUnderTheSeedOfAnInspectionHasNoiseOfItsOwn) {
  const auto share_of_both = [](const std::vector<bool>& a, const std::vector<bool>& b) {
    double both = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) both += a[i] && b[i];
    return both / static_cast<double>(a.size());
  };
  const std::vector<bool> inspection = dropouts("inspection", 1), reference = dropouts("reference", 1);
  ASSERT_GT(inspection.size(), 2000u);
  EXPECT_NEAR(share_of_both(inspection, inspection), 0.1, 0.03);
  EXPECT_NEAR(share_of_both(reference, reference), 0.1, 0.03);
  EXPECT_NEAR(share_of_both(inspection, reference), 0.01, 0.01);
  EXPECT_EQ(inspection, dropouts("inspection", 1));
}

TEST(PanoramicScanner, AllImperfectionsOfAReferenceDifferFromThoseOfAnInspection) {
  const SmallWorld world(kRoom);
  const auto first_range_m = [&](const std::string& epoch, auto set) {
    PanoramicScannerSettings settings = ideal();
    settings.epoch = epoch;
    set(settings);
    return position_of(scan(world, settings).points.at(1234)).norm();
  };
  const auto expect_apart = [&](auto set) {
    EXPECT_NE(first_range_m("inspection", set), first_range_m("reference", set));
  };
  expect_apart([](PanoramicScannerSettings& settings) { settings.range_noise_std_m = 0.001; });
  expect_apart([](PanoramicScannerSettings& settings) { settings.range_offset_std_m = 0.001; });
  expect_apart([](PanoramicScannerSettings& settings) { settings.angle_noise_std_deg = 0.5; });
  const auto height_m = [&](const std::string& epoch) {
    PanoramicScannerSettings settings = ideal();
    settings.epoch = epoch;
    settings.tilt_error_std_deg = 0.5;
    return scan(world, settings).points.at(1234).z;
  };
  EXPECT_NE(height_m("inspection"), height_m("reference"));
}

TEST(PanoramicScanner, AnEpochIsReferenceOrInspection) {
  const SmallWorld world(kRoom);
  PanoramicScannerSettings settings = ideal();
  settings.epoch = "first";
  EXPECT_THROW(PanoramicScanner(settings, world.scene, {}, 1), InputError);
}

TEST(PanoramicScanner, OnATiltedRobotThePointsAreLevelAndKeepTheScannersHeading) {
  const SmallWorld world(kRoom);
  for (const ScannerPoint& point : scan(world, ideal(), 1, kTilted).points) {
    const Eigen::Vector3d in_room = quaternion_from_yaw(0.4) * position_of(point);
    ASSERT_NEAR(in_room.norm(), room_range(in_room.normalized()), 1e-4);
  }
}

}  // namespace
}  // namespace patrol::sim::panoramic_scanner_test
