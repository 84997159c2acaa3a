#include "sim/gas_plume.h"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "tests/sim/small_world.h"

namespace patrol::sim::gas_plume_test {
namespace {

constexpr double kPi = std::numbers::pi;

/// From the west, so that downwind is +x; class D spreads by 0.16 and 0.14 of the way (Briggs, urban).
WindSettings west_wind() { return {.speed_mps = 2.0, .direction_deg = 270.0, .stability = "D"}; }

double sigma_y(double x) { return std::hypot(0.15, 0.16 * x); }
double sigma_z(double x) { return std::hypot(0.15, 0.14 * x); }

constexpr double kRate_gps = 1.5;
const Eigen::Vector3d kSource(0.0, 0.0, 0.8);

GasPlume plume() { return GasPlume(kSource, kRate_gps, west_wind()); }

TEST(GasPlume, OnTheCentreLineItIsTurnersFormulaWithReflectionAtTheGround) {
  for (const double x : {2.0, 5.0, 20.0, 50.0}) {
    const double reflected = std::exp(-0.5 * std::pow(2.0 * 0.8 / sigma_z(x), 2));
    const double expected = 1.5e-3 / (2.0 * kPi * 2.0 * sigma_y(x) * sigma_z(x)) * (1.0 + reflected);
    EXPECT_NEAR(plume().concentration_kgpm3({x, 0.0, 0.8}, 0.0), expected, 1e-9 * expected) << x;
  }
}

TEST(GasPlume, CarriesItsWholeRateThroughEveryPlaneDownwind) {
  for (const double x : {1.0, 10.0, 40.0}) {
    double flux_kgps = 0.0;
    constexpr double kCell = 0.02;
    for (double y = -6.0 * sigma_y(x); y < 6.0 * sigma_y(x); y += kCell * sigma_y(x)) {
      for (double z = 0.5 * kCell * sigma_z(x); z < 0.8 + 6.0 * sigma_z(x); z += kCell * sigma_z(x)) {
        flux_kgps += 2.0 * plume().concentration_kgpm3({x, y, z}, 0.0) * kCell * sigma_y(x) * kCell * sigma_z(x);
      }
    }
    EXPECT_NEAR(flux_kgps * 1000.0, kRate_gps, 0.002 * kRate_gps) << x;
  }
}

TEST(GasPlume, AColumnAcrossTheWindIsTheClosedFormWithin1Percent) {
  for (const double x : {1.0, 3.0, 10.0}) {
    const double reflected = std::exp(-0.5 * std::pow(2.0 * 0.8 / sigma_z(x), 2));
    const double kg_m2 = 1.5e-3 / (std::sqrt(2.0 * kPi) * 2.0 * sigma_z(x)) * (1.0 + reflected);
    const double expected_ppm_m = kg_m2 / kMethaneDensity_kgpm3 * 1e6;
    const double half = 8.0 * sigma_y(x);
    EXPECT_NEAR(plume().column_ppm_m({x, -half, 0.8}, {0, 1, 0}, 2.0 * half, 0.0), expected_ppm_m,
                0.01 * expected_ppm_m)
        << x;
  }
}

TEST(GasPlume, AColumnAlongAnyBeamIsTheIntegralBy1MillimetreStepsWithin1Percent) {
  const Eigen::Vector3d origins[] = {{-2, -3, 0.4}, {8, 2, 1.0}, {1, -0.5, 0.3}, {0.4, -4.0, 0.8}};
  for (const Eigen::Vector3d& origin : origins) {
    const Eigen::Vector3d direction = (Eigen::Vector3d(1.0, 0.1, 0.9) - origin).normalized();
    double sum = 0.0;
    for (int i = 0; i < 9000; ++i)
      sum += plume().concentration_kgpm3(origin + (i + 0.5) * 1e-3 * direction, 0.0) * 1e-3;
    const double expected_ppm_m = sum / kMethaneDensity_kgpm3 * 1e6;
    EXPECT_NEAR(plume().column_ppm_m(origin, direction, 9.0, 0.0), expected_ppm_m, 0.01 * expected_ppm_m)
        << origin.transpose();
  }
}

TEST(GasPlume, WindFrom240DegreesDrivesTheGasTo60DegreesFromNorth) {
  const GasPlume gas(kSource, 1.0, {.speed_mps = 1.5, .direction_deg = 240.0, .stability = "D"});
  double strongest = 0.0, strongest_deg = 0.0;
  for (int bearing = 0; bearing < 360; ++bearing) {
    const double angle = to_rad(bearing);
    const double here =
        gas.concentration_kgpm3(kSource + 5.0 * Eigen::Vector3d(std::sin(angle), std::cos(angle), 0.0), 0.0);
    if (here > strongest) strongest = here, strongest_deg = bearing;
  }
  EXPECT_EQ(strongest_deg, 60.0);
}

TEST(GasPlume, NothingGoesHalfAMetreUpwind) { EXPECT_EQ(plume().concentration_kgpm3({-0.5, 0.0, 0.8}, 0.0), 0.0); }

TEST(GasPlume, StableAirKeepsTheGasTogetherUnstableAirSpreadsIt) {
  double last = 0.0;
  for (const char* stability : {"A", "C", "D", "F"}) {
    const GasPlume gas(kSource, 1.0, {.speed_mps = 2.0, .direction_deg = 270.0, .stability = stability});
    const double here = gas.concentration_kgpm3({20.0, 0.0, 0.8}, 0.0);
    EXPECT_GT(here, last) << stability;
    last = here;
  }
}

TEST(GasPlume, IsNeverMoreThanPureMethane) {
  const GasPlume gas(kSource, 1e6, west_wind());
  EXPECT_EQ(gas.concentration_kgpm3(kSource, 0.0), kMethaneDensity_kgpm3);
}

TEST(GasPlume, TwoLeaksAddAndEachBeginsAtItsTime) {
  const SmallWorld world(R"(<site name="box" pos="0 0 0.8"/><site name="well" pos="3 1 0.2"/>)");
  const GasPlume both(*world.model,
                      {{.at = "box", .rate_g_s = kRate_gps}, {.at = "well", .rate_g_s = 0.5, .start_s = 10.0}},
                      west_wind());
  const GasPlume well({3, 1, 0.2}, 0.5, west_wind());
  const Eigen::Vector3d point(8.0, 0.5, 0.6);
  const double box_only = plume().concentration_kgpm3(point, 0.0);
  EXPECT_DOUBLE_EQ(both.concentration_kgpm3(point, 9.9), box_only);
  EXPECT_DOUBLE_EQ(both.concentration_kgpm3(point, 10.0), box_only + well.concentration_kgpm3(point, 0.0));
}

TEST(GasPlume, AnUnknownSiteIsRefusedAndTheKnownOnesAreNamed) {
  const SmallWorld world(R"(<site pos="1 1 1"/><site name="box" pos="0 0 0.8"/><site name="well" pos="3 1 0.2"/>)");
  try {
    GasPlume(*world.model, {{.at = "bxo"}}, west_wind());
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("bxo"));
    EXPECT_THAT(error.what(), testing::HasSubstr("known: box, well"));
  }
}

TEST(GasPlume, ASiteOfABodyIsRefusedBecauseItsPositionIsNotInWorld) {
  const SmallWorld world(
      R"(<body name="robot"><freejoint/><geom size="0.1"/><site name="imu" pos="0.1 0 0"/></body><site name="box"/>)");
  EXPECT_THAT([&] { GasPlume(*world.model, {{.at = "imu"}}, west_wind()); },
              testing::ThrowsMessage<InputError>(
                  "leaks: at = imu: site of the body robot: must be a site of the world (known: box)"));
}

}  // namespace
}  // namespace patrol::sim::gas_plume_test
