#include "sim/sensors/panoramic_scanner.h"
#include "tests/sim/sensors/panoramic_scans.h"

namespace patrol::sim::panoramic_scanner_test {
namespace {

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
