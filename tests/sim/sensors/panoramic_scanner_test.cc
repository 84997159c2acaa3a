#include "sim/sensors/panoramic_scanner.h"

#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "tests/sim/small_world.h"

namespace patrol::sim::panoramic_scanner_test {
namespace {

std::string box(const std::string& position, const std::string& size, double grey = 1.0, const std::string& more = "") {
  const std::string g = std::to_string(grey);
  return R"(<geom type="box" pos=")" + position + R"(" size=")" + size + R"(" rgba=")" + g + " " + g + " " + g +
         R"( 1" )" + more + "/>";
}

/// Walls at +-4 m in x and +-3 m in y, ceiling 3 m above, floor 2 m below.
const std::string kRoom = box("4.5 0 0", "0.5 4 4") + box("-4.5 0 0", "0.5 4 4") + box("0 3.5 0", "5 0.5 4") +
                          box("0 -3.5 0", "5 0.5 4") + box("0 0 3.5", "5 4 0.5") + box("0 0 -2.5", "5 4 0.5");

double room_range(const Eigen::Vector3d& direction) {
  const double up = direction.z() > 0.0 ? 3.0 / direction.z() : direction.z() < 0.0 ? -2.0 / direction.z() : 1e9;
  return std::min({4.0 / std::abs(direction.x()), 3.0 / std::abs(direction.y()), up});
}

Eigen::Vector3d position_of(const ScannerPoint& point) { return {point.x, point.y, point.z}; }

/// Everything perfect, and few directions.
PanoramicScannerSettings ideal() {
  PanoramicScannerSettings settings;
  settings.enabled = true;
  settings.step_deg = 2.0;
  settings.range_noise_std_m = settings.gray_noise_std_m = settings.range_offset_std_m = settings.angle_noise_std_deg =
      0.0;
  settings.tilt_error_std_deg = settings.beam_divergence_rad = settings.dropout_probability = 0.0;
  settings.max_incidence_deg = 90.0;
  settings.range_min_m = 0.0;
  return settings;
}

using PoseAt = std::function<Pose3(double now_s)>;

/// The next scan of a scanner that is the body itself, carried along.
PanoramicScan next_scan(
    PanoramicScanner& scanner, double duration_s, const PoseAt& pose = [](double) { return Pose3{}; }) {
  scanner.begin(Time{}, pose(0.0));
  const Time tick = from_seconds(duration_s / 60.0);
  for (Time now{}; scanner.is_busy(); now += tick)
    scanner.advance(now, now + tick, pose(to_seconds(now)), pose(to_seconds(now + tick)));
  return std::move(scanner.take_scans().at(0));
}

PanoramicScan scan(
    const SmallWorld& world, const PanoramicScannerSettings& settings, std::uint64_t seed = 1,
    const PoseAt& pose = [](double) { return Pose3{}; }, const DustSettings& dust = {}) {
  PanoramicScanner scanner(settings, world.scene, {}, seed, dust);
  return next_scan(scanner, settings.duration_s, pose);
}

/// Range by beam (azimuth and elevation in steps), of those that look within some degrees of +x.
std::map<std::pair<long, long>, double> ranges_ahead(const PanoramicScan& scan, double step_deg, double within_deg) {
  std::map<std::pair<long, long>, double> ranges_m;
  for (const ScannerPoint& point : scan.points) {
    const Eigen::Vector3d p = position_of(point), direction = p.normalized();
    if (direction.x() < std::cos(within_deg * kDegree)) continue;
    const double azimuth_deg = std::atan2(direction.y(), direction.x()) / kDegree,
                 elevation_deg = std::asin(direction.z()) / kDegree;
    ranges_m[{std::lround(azimuth_deg / step_deg), std::lround(elevation_deg / step_deg)}] = p.norm();
  }
  return ranges_m;
}

/// Measured range less that of the flawless scan, m; of beams that look within some degrees of +x.
test::Moments range_errors(const SmallWorld& world, const PanoramicScannerSettings& settings, double within_deg) {
  PanoramicScannerSettings flawless = ideal();
  flawless.step_deg = settings.step_deg;
  flawless.elevation_min_deg = settings.elevation_min_deg;
  const auto measured = ranges_ahead(scan(world, settings), settings.step_deg, within_deg);
  const auto exact = ranges_ahead(scan(world, flawless), settings.step_deg, within_deg);
  EXPECT_EQ(measured.size(), exact.size());
  test::Moments errors;
  for (const auto& [beam, range_m] : exact) errors.add(measured.at(beam) - range_m);
  return errors;
}

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

const PoseAt kTilted = [](double) { return Pose3{Eigen::Vector3d::Zero(), quaternion_from_rpy(0.02, -0.015, 0.4)}; };

/// Bits of beams that drop out in a room, of a grid without another imperfection.
std::vector<bool> dropouts(const std::string& epoch, std::uint64_t seed) {
  const SmallWorld world(kRoom);
  PanoramicScannerSettings settings = ideal();
  settings.epoch = epoch;
  settings.dropout_probability = 0.1;
  const auto complete = ranges_ahead(scan(world, ideal()), settings.step_deg, 60.0);
  const auto taken = ranges_ahead(scan(world, settings, seed), settings.step_deg, 60.0);
  std::vector<bool> is_lost;
  for (const auto& [beam, range_m] : complete) is_lost.push_back(!taken.contains(beam));
  return is_lost;
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

TEST(PanoramicScanner, TheCompensatorLeaves19ArcSecondsOfTiltAboutEachAxisFromScanToScan) {
  const SmallWorld world(R"(<geom type="plane" pos="0 0 -2" size="500 500 1" rgba="1 1 1 1"/>)");
  PanoramicScannerSettings settings = ideal();
  settings.step_deg = 10.0;
  settings.tilt_error_std_deg = 19.0 / 3600.0;
  PanoramicScanner scanner(settings, world.scene, {}, 1);
  test::Moments about_x, about_y;
  for (int i = 0; i < 300; ++i) {
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();  // of the plane z = a + b x + c y, by least squares
    Eigen::Vector3d sums = Eigen::Vector3d::Zero();
    for (const ScannerPoint& point : next_scan(scanner, settings.duration_s, kTilted).points) {
      const Eigen::Vector3d row(1.0, point.x, point.y);
      squares += row * row.transpose();
      sums += row * static_cast<double>(point.z);
    }
    const Eigen::Vector3d plane = squares.ldlt().solve(sums);
    about_x.add(plane[2]), about_y.add(-plane[1]);
  }
  const double std_rad = 19.0 / 3600.0 * kDegree, tol_rad = 4.0 * std_rad / std::sqrt(2.0 * 300);
  EXPECT_NEAR(about_x.std(), std_rad, tol_rad);
  EXPECT_NEAR(about_y.std(), std_rad, tol_rad);
  EXPECT_NEAR(about_x.mean(), 0.0, 2.0 * tol_rad);
  EXPECT_NEAR(about_y.mean(), 0.0, 2.0 * tol_rad);
}

TEST(PanoramicScanner, TheRobotsBodyHidesWhatIsBehindItAndTheScannersOwnHousingIsNotSeen) {
  const std::string robot = R"(<body name="base_link"><freejoint/><inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>
      <geom type="box" pos="1 0 0" size="0.1 0.1 0.1" group="4" rgba="1 1 1 1" contype="0" conaffinity="0"/>
      <body name="scanner"><inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>
        <geom type="sphere" size="0.1" group="4" rgba="1 1 1 1" contype="0" conaffinity="0"/></body></body>)";
  const SmallWorld bare(kRoom), carried(kRoom + robot);
  PanoramicScannerSettings settings = ideal();
  settings.step_deg = 1.0;
  const PanoramicScan without = scan(bare, settings), with = scan(carried, settings);
  ASSERT_EQ(without.points.size(), with.points.size());
  int hidden = 0;
  for (std::size_t i = 0; i < with.points.size(); ++i) {
    const Eigen::Vector3d p = position_of(without.points[i]);
    const bool is_behind =
        p.x() > 0.0 && std::abs(p.y()) < p.x() * 0.1 / 0.9 - 1e-6 && std::abs(p.z()) < p.x() * 0.1 / 0.9 - 1e-6;
    EXPECT_NEAR(with.points[i].x, is_behind ? 0.9 : p.x(), 1e-4);
    hidden += is_behind;
  }
  EXPECT_EQ(hidden, 13 * 13);  // atan(1 / 9) = 6.3 degrees to every side
  settings.range_min_m = 1.0;
  EXPECT_EQ(scan(carried, settings).points.size(), without.points.size() - 13 * 13)
      << "too near to be measured, and still in the way";
}

// Half a turn in 30 s: the column that looks ahead when half the time is over has its fellow behind at the same
// instant.
TEST(PanoramicScanner, OnARobotThatCreepsAMillimetreASecondTheWallAheadIs15NearerAndTheOneBehind15Farther) {
  const SmallWorld world(kRoom);
  const auto creeping = [](double now) {
    return Pose3{Eigen::Vector3d(0.001 * now, 0, 0), Eigen::Quaterniond::Identity()};
  };
  int ahead = 0, behind = 0;
  for (const ScannerPoint& point : scan(world, ideal(), 1, creeping).points) {
    if (std::abs(point.y) > 1e-6 || std::abs(point.z) > 0.2 * std::abs(point.x)) continue;
    const double instant_s = 30.0 * 46.0 / 90.0;  // the 46th of 90 pairs looks along x
    EXPECT_NEAR(point.x, (point.x > 0.0 ? 4.0 : -4.0) - 0.001 * instant_s, 1e-5);
    ++(point.x > 0.0 ? ahead : behind);
  }
  EXPECT_GT(ahead, 10);
  EXPECT_EQ(ahead, behind);
}

// Seen in a frame that has turned by the angle t since the start, a point (4, y) of the wall lies at x = 4 + t y.
TEST(PanoramicScanner, ARobotThatTurnsByATwentiethOfADegreeBendsTheWallByThat) {
  const SmallWorld world(kRoom);
  const auto turning = [](double now) {
    return Pose3{Eigen::Vector3d::Zero(), quaternion_from_yaw(0.05 * kDegree * now / 30.0)};
  };
  int looked = 0;
  for (const ScannerPoint& point : scan(world, ideal(), 1, turning).points) {
    if (point.x < 3.5F || std::abs(point.y) < 0.5F || std::abs(point.y) > 2.9F || std::abs(point.z) > 1.0F) continue;
    const double pair = (std::atan2(point.y, point.x) / kDegree + 90.0) / 2.0,
                 turned_rad = 0.05 * kDegree * (pair + 1.0) / 90.0;
    EXPECT_NEAR((point.x - 4.0) / point.y, turned_rad, 0.002 * kDegree);
    ++looked;
  }
  EXPECT_GT(looked, 300);
}

TEST(PanoramicScanner, AtAnEdgeSomeBeamsReturnARangeBetweenTheSurfacesUnlessTheyHaveNoWidth) {
  const SmallWorld world(box("2 -5 0", "0.001 5 9", 1.0, R"(euler="7 0 0")") + box("4.5 0 0", "0.5 20 20"));
  PanoramicScannerSettings settings = ideal();
  settings.step_deg = 0.18;
  settings.elevation_min_deg = -40.0;
  const auto count_between = [&] {
    int between = 0;
    for (const ScannerPoint& point : scan(world, settings).points) between += point.x > 2.05 && point.x < 3.95;
    return between;
  };
  EXPECT_EQ(count_between(), 0);
  settings.beam_divergence_rad = 0.0003;
  const int mixed = count_between();
  // The edge crosses some 500 rows; the four rays of a beam span half its width of 0.095 degrees there, of 0.18 from
  // beam to beam.
  EXPECT_GT(mixed, 60);
  EXPECT_LT(mixed, 300);
}

TEST(PanoramicScanner, BlackIsSeenTo50MetresGreyTo70AndNothingNearerThan60Centimetres) {
  const auto is_seen = [](double distance_m, double grey) {
    const SmallWorld world(box(std::to_string(distance_m + 0.5) + " 0 0", "0.5 9 9", grey));
    PanoramicScannerSettings settings = ideal();
    settings.range_min_m = 0.6;
    settings.elevation_min_deg = 0.0;
    for (const ScannerPoint& point : scan(world, settings).points) {
      if (std::hypot(point.y, point.z) < 1e-3) return true;
    }
    return false;
  };
  EXPECT_TRUE(is_seen(49.9, 0.02));
  EXPECT_FALSE(is_seen(50.1, 0.02));
  EXPECT_TRUE(is_seen(69.9, 0.1));
  EXPECT_FALSE(is_seen(70.1, 1.0));
  EXPECT_TRUE(is_seen(0.61, 1.0));
  EXPECT_FALSE(is_seen(0.59, 1.0));
}

TEST(PanoramicScanner, GrazingBeamsBeyond85DegreesAreLost) {
  const SmallWorld world(R"(<geom type="plane" pos="0 0 -1" size="200 200 1" rgba="1 1 1 1"/>)");
  PanoramicScannerSettings settings = ideal();
  settings.step_deg = 0.5;
  settings.max_incidence_deg = 85.0;
  double farthest_m = 0.0;
  for (const ScannerPoint& point : scan(world, settings).points)
    farthest_m = std::max(farthest_m, position_of(point).norm());
  EXPECT_NEAR(farthest_m, 1.0 / std::sin(5.0 * kDegree), 0.01);
}

// Light falls by ln 50 / 20 m = 0.1956 / m, and white is seen as from 50 sqrt(1 / 0.02) = 354 m: at 15 m it is as from
// 282, at 17 m as from 473.
TEST(PanoramicScanner, InDustOf20MetresVisibilityAWhiteWallIsSeenAt15MetresAndNotAt17) {
  const DustSettings dust{.enabled = true, .visibility_m = 20.0};
  for (const auto& [distance_m, is_seen] : {std::pair{15.0, true}, {17.0, false}}) {
    const SmallWorld world(box(std::to_string(distance_m + 0.5) + " 0 0", "0.5 1 1"));
    EXPECT_EQ(!scan(
                   world, ideal(), 1, [](double) { return Pose3{}; }, dust)
                   .points.empty(),
              is_seen)
        << distance_m;
  }
}

TEST(PanoramicScanner, OneInAThousandBeamsIsLost) {
  const SmallWorld world(kRoom);
  PanoramicScannerSettings settings = ideal();
  settings.step_deg = 0.5;
  const std::size_t all = scan(world, settings).points.size();
  settings.dropout_probability = 0.001;
  const double lost = static_cast<double>(all - scan(world, settings).points.size());
  EXPECT_NEAR(lost, 0.001 * static_cast<double>(all), 4.0 * std::sqrt(0.001 * static_cast<double>(all)));
}

bool are_same(const PanoramicScan& a, const PanoramicScan& b) {
  return std::equal(a.points.begin(), a.points.end(), b.points.begin(), b.points.end(),
                    [](const ScannerPoint& p, const ScannerPoint& q) {
                      return p.x == q.x && p.y == q.y && p.z == q.z && p.intensity == q.intensity;
                    });
}

TEST(PanoramicScanner, TheSameSeedGivesTheSameScanAndTheNextScanOrAnotherSeedOthers) {
  const SmallWorld world(kRoom);
  PanoramicScannerSettings settings;
  settings.step_deg = 3.0;
  PanoramicScanner scanner(settings, world.scene, {}, 1), same(settings, world.scene, {}, 1),
      other(settings, world.scene, {}, 2);
  const PanoramicScan first = next_scan(scanner, settings.duration_s);
  EXPECT_TRUE(are_same(first, next_scan(same, settings.duration_s)));
  EXPECT_FALSE(are_same(first, next_scan(scanner, settings.duration_s)));
  EXPECT_FALSE(are_same(first, next_scan(other, settings.duration_s)));
}

TEST(PanoramicScanner, WithoutRangeNoiseTheSameBeamsAreLostAndTheOthersPointsStayWithinItsWidth) {
  const SmallWorld world(kRoom);
  PanoramicScannerSettings settings;
  settings.step_deg = 3.0;
  settings.dropout_probability = 0.1;
  const PanoramicScan noisy = scan(world, settings);
  settings.range_noise_std_m = settings.gray_noise_std_m = 0.0;
  const PanoramicScan calm = scan(world, settings);
  ASSERT_EQ(noisy.points.size(), calm.points.size());
  for (std::size_t i = 0; i < calm.points.size(); ++i)
    ASSERT_LT((position_of(noisy.points[i]) - position_of(calm.points[i])).norm(), 0.0025);
}

TEST(PanoramicScanner, AStepOfNothingIsRefusedByItsName) {
  const SmallWorld world(kRoom);
  PanoramicScannerSettings settings;
  settings.step_deg = 0.0;
  try {
    PanoramicScanner scanner(settings, world.scene, {}, 1);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "sensors.scanner.step_deg = 0: must be in [0.09, 10]");
  }
}

}  // namespace
}  // namespace patrol::sim::panoramic_scanner_test
