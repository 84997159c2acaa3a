#include "sim/sensors/gnss.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "tests/sim/small_world.h"

namespace patrol::sim::gnss_test {
namespace {

/// A court of walls 20 m high about the origin, open at the top; 2 m wide in the middle of nothing else.
const std::string kCourt =
    R"(<geom type="box" pos="2 0 10" size="0.5 3 10"/><geom type="box" pos="-2 0 10" size="0.5 3 10"/>
  <geom type="box" pos="0 2 10" size="3 0.5 10"/><geom type="box" pos="0 -2 10" size="3 0.5 10"/>)";
/// One long house, 8 m high, 4 m to the west.
const std::string kHouse = R"(<geom type="box" pos="-6 0 4" size="2 60 4"/>)";

const Eigen::Vector3d kField(300, 300, 1);  // nothing stands near it

/// WGS 84 to Earth-centred coordinates.
Eigen::Vector3d to_ecef(double latitude_deg, double longitude_deg, double altitude_m) {
  const double a = 6378137.0, f = 1.0 / 298.257223563, e2 = f * (2.0 - f);
  const double lat = latitude_deg * kDegree, lon = longitude_deg * kDegree;
  const double n = a / std::sqrt(1.0 - e2 * std::sin(lat) * std::sin(lat));
  return {(n + altitude_m) * std::cos(lat) * std::cos(lon), (n + altitude_m) * std::cos(lat) * std::sin(lon),
          (n * (1.0 - e2) + altitude_m) * std::sin(lat)};
}

/// The fix back in the world's axes: the tangent plane at the datum, by way of the Earth's centre.
Eigen::Vector3d to_world(const GnssFix& fix, const GnssSettings& settings) {
  const double lat = settings.datum_latitude_deg * kDegree, lon = settings.datum_longitude_deg * kDegree;
  const Eigen::Vector3d d = to_ecef(fix.latitude_deg, fix.longitude_deg, fix.altitude_m) -
                            to_ecef(settings.datum_latitude_deg, settings.datum_longitude_deg, 0.0);
  return {-std::sin(lon) * d.x() + std::cos(lon) * d.y(),
          -std::sin(lat) * std::cos(lon) * d.x() - std::sin(lat) * std::sin(lon) * d.y() + std::cos(lat) * d.z(),
          std::cos(lat) * std::cos(lon) * d.x() + std::cos(lat) * std::sin(lon) * d.y() + std::sin(lat) * d.z()};
}

TEST(Gnss, WithoutNoiseItIsTheAntennaWithin2MillimetresOverTheBlock) {
  const SmallWorld world(kCourt);
  GnssSettings settings;
  settings.fix_noise_std_m = 0.0;
  Gnss gnss(settings, 1);
  std::uint64_t tick = 0;
  for (const Eigen::Vector3d& place :
       {Eigen::Vector3d(10, 0, 1), Eigen::Vector3d(60, 100, 1), Eigen::Vector3d(0, 50, 5)}) {
    const GnssFix fix = gnss.read(world.scene, place, Time{}, tick++);
    EXPECT_NEAR((to_world(fix, settings) - place).norm(), 0.0, 0.002) << place.transpose();
  }
}

struct Spread {
  test::Moments east, north, up;
  double lag_1 = 0.0;  ///< autocorrelation of the east error, from reading to reading
};

Spread spread_at(const Eigen::Vector3d& place, const SmallWorld& world, GnssStatus status,
                 const GnssSettings& settings) {
  Gnss gnss(settings, 11);
  Spread spread;
  std::vector<double> east;
  for (std::uint64_t tick = 0; tick < 10000; ++tick) {
    const GnssFix fix = gnss.read(world.scene, place, from_seconds(0.2 * static_cast<double>(tick)), tick);
    EXPECT_EQ(fix.status, status);
    const Eigen::Vector3d error = to_world(fix, settings) - place;
    spread.east.add(error.x());
    spread.north.add(error.y());
    spread.up.add(error.z());
    east.push_back(error.x());
  }
  for (std::size_t i = 1; i < east.size(); ++i) spread.lag_1 += east[i] * east[i - 1];
  spread.lag_1 /= spread.east.squares;
  return spread;
}

TEST(Gnss, FixNoiseIs1CentimetreAcrossAnd2CentimetresUp) {
  const SmallWorld world(kCourt);
  GnssSettings settings;
  settings.error_correlation_time_s = 0.4;
  const Spread spread = spread_at({30, 30, 1}, world, GnssStatus::kFix, settings);
  EXPECT_NEAR(spread.east.std(), 0.01, 0.0004);
  EXPECT_NEAR(spread.north.std(), 0.01, 0.0004);
  EXPECT_NEAR(spread.up.std(), 0.02, 0.0008);
  EXPECT_NEAR(spread.lag_1, std::exp(-0.2 / 0.4), 0.02);
}

TEST(Gnss, TheErrorIsCorrelatedOver20Seconds) {
  const SmallWorld world(kCourt);
  const Spread spread = spread_at({30, 30, 1}, world, GnssStatus::kFix, {});
  EXPECT_NEAR(spread.lag_1, std::exp(-0.2 / 20.0), 0.003);
}

TEST(Gnss, BesideAHouseTheSolutionFloatsWith40CentimetresOfNoise) {
  const SmallWorld world(kHouse);
  GnssSettings settings;
  settings.error_correlation_time_s = 0.4;
  const Spread spread = spread_at({-3.5, 0, 1}, world, GnssStatus::kFloat, settings);
  EXPECT_NEAR(spread.east.std(), 0.4, 0.016);
  EXPECT_NEAR(spread.up.std(), 0.8, 0.032);
}

TEST(Gnss, InANarrowCourtThereIsNoSolution) {
  const SmallWorld world(kCourt);
  const GnssFix fix = Gnss({}, 1).read(world.scene, {0, 0, 1}, Time{}, 0);
  EXPECT_EQ(fix.status, GnssStatus::kNone);
  EXPECT_EQ(fix.latitude_deg, 0.0);
}

TEST(Gnss, AfterALossTheFixComesBackFiveSecondsLater) {
  const SmallWorld world(kCourt);
  Gnss gnss({}, 1);
  std::uint64_t tick = 0;
  const auto status_at = [&](double seconds, const Eigen::Vector3d& place) {
    return gnss.read(world.scene, place, from_seconds(seconds), tick++).status;
  };
  EXPECT_EQ(status_at(0.0, kField), GnssStatus::kFix);
  EXPECT_EQ(status_at(1.0, {0, 0, 1}), GnssStatus::kNone);
  EXPECT_EQ(status_at(2.0, kField), GnssStatus::kFloat);
  EXPECT_EQ(status_at(6.8, kField), GnssStatus::kFloat);
  EXPECT_EQ(status_at(7.0, kField), GnssStatus::kFix);
}

}  // namespace
}  // namespace patrol::sim::gnss_test
