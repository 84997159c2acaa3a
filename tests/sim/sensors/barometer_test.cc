#include "sim/sensors/barometer.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "io/ros/ros_messages.h"
#include "tests/support/moments.h"

namespace patrol::sim::barometer_test {
namespace {

BarometerSettings ideal() {
  BarometerSettings settings;
  settings.noise_std_pa = settings.offset_std_pa = settings.drift_std_pa =
      settings.temperature_coefficient_std_pa_per_k = settings.resolution_pa = 0.0;
  return settings;
}

/// Readings at height 0 and the settings' rate.
std::vector<double> record_pa(const BarometerSettings& settings, std::uint64_t readings, std::uint64_t seed = 1) {
  Barometer barometer(settings, seed);
  std::vector<double> pressures;
  for (std::uint64_t i = 0; i < readings; ++i) {
    pressures.push_back(barometer.read(0.0, from_seconds(static_cast<double>(i) / settings.rate_hz), i).pressure_pa);
  }
  return pressures;
}

// Table values of the standard atmosphere (ISO 2533): altitude, m, and pressure, Pa.
TEST(Barometer, PressureFollowsTheStandardAtmosphere) {
  const double table[][2] = {{0.0, 101325.0}, {100.0, 100129.4}, {1000.0, 89874.6}, {5000.0, 54019.9}};
  for (const auto& [height_m, pressure_pa] : table) {
    EXPECT_NEAR(Barometer(ideal(), 1).read(height_m, Time{}, 0).pressure_pa, pressure_pa, 2e-5 * pressure_pa)
        << height_m;
  }
  EXPECT_NEAR(air_pressure_pa({}, 0.0) - air_pressure_pa({}, 1.0), 12.01, 0.02) << "12 Pa a meter at sea level";
}

TEST(Barometer, AltitudeOfTheOriginAndPressureAtSeaLevelShiftTheReading) {
  BarometerSettings settings = ideal();
  settings.origin_altitude_m = 90.0;
  EXPECT_DOUBLE_EQ(air_pressure_pa(settings, 10.0), air_pressure_pa(ideal(), 100.0));
  settings.sea_level_pa = 99000.0;
  EXPECT_NEAR(air_pressure_pa(settings, 10.0) / air_pressure_pa(ideal(), 100.0), 99000.0 / 101325.0, 1e-12);
}

TEST(Barometer, NoiseOfTheDefaultsIs2HundredthsOfAPascalInStepsOf16Thousandths) {
  BarometerSettings settings;
  settings.drift_std_pa = settings.offset_std_pa = settings.temperature_coefficient_std_pa_per_k = 0.0;
  test::Moments moments;
  for (const double pressure_pa : record_pa(settings, 20000)) {
    moments.add(pressure_pa - 101325.0);
    EXPECT_NEAR(pressure_pa / 0.016, std::round(pressure_pa / 0.016), 1e-6);
  }
  EXPECT_NEAR(moments.std(), std::hypot(0.02, 0.016 / std::sqrt(12.0)), 0.03 * 0.02);
  EXPECT_NEAR(moments.mean(), 0.0, 4.0 * 0.021 / std::sqrt(20000.0));
}

TEST(Barometer, OffsetAndTemperatureCoefficientOfTheDefaultsHaveTheirStandardDeviationsOverSensors) {
  BarometerSettings settings;
  settings.noise_std_pa = settings.drift_std_pa = settings.resolution_pa = 0.0;
  test::Moments offset_pa, change_pa_per_k;
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    Barometer barometer(settings, seed);
    const double cold_pa = barometer.read(0.0, Time{}, 0).pressure_pa,
                 warm_pa = barometer.read(0.0, from_seconds(1e5), 1).pressure_pa;
    offset_pa.add(cold_pa - 101325.0);
    change_pa_per_k.add((warm_pa - cold_pa) / 8.0);
  }
  EXPECT_NEAR(offset_pa.std(), 25.0, 0.06 * 25.0);
  EXPECT_NEAR(change_pa_per_k.std(), 0.3, 0.06 * 0.3);
}

TEST(Barometer, TheWarmingOfTheDefaultsReaches63PercentAfterFiveMinutes) {
  BarometerSettings settings = ideal();
  settings.temperature_coefficient_std_pa_per_k = 0.3;
  Barometer barometer(settings, 1);
  const double cold_pa = barometer.read(0.0, Time{}, 0).pressure_pa,
               later_pa = barometer.read(0.0, from_seconds(300.0), 1).pressure_pa,
               warm_pa = barometer.read(0.0, from_seconds(1e5), 2).pressure_pa;
  EXPECT_NEAR((later_pa - cold_pa) / (warm_pa - cold_pa), 1.0 - std::exp(-1.0), 1e-6);
}

// A Gauss-Markov process of standard deviation s and correlation time T changes by s sqrt(2 (1 - exp(-t / T))) over t.
TEST(Barometer, TheDriftOfTheDefaultsIsAGaussMarkovProcessOf1AndAHalfPascalAndTenMinutes) {
  BarometerSettings settings = ideal();
  settings.drift_std_pa = 1.5;
  test::Moments level_pa, over_a_minute_pa, over_ten_minutes_pa;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const std::vector<double> pressures = record_pa(settings, 3001, seed);
    level_pa.add(pressures[3000] - 101325.0);
    over_a_minute_pa.add(pressures[3000] - pressures[2700]);
    over_ten_minutes_pa.add(pressures[3000] - pressures[0]);
  }
  EXPECT_NEAR(level_pa.std(), 1.5, 0.14 * 1.5);
  EXPECT_NEAR(over_a_minute_pa.std(), 1.5 * std::sqrt(2.0 * (1.0 - std::exp(-0.1))), 0.14 * 0.65);
  EXPECT_NEAR(over_ten_minutes_pa.std(), 1.5 * std::sqrt(2.0 * (1.0 - std::exp(-1.0))), 0.14 * 1.69);
}

TEST(Barometer, TheMessageComesBackFromItsRosEncoding) {
  const FluidPressure reading{.stamp = from_seconds(3.25), .pressure_pa = 100129.5, .std_pa = 0.02};
  const auto decoded = io::decode<FluidPressure>(io::encode(reading));
  EXPECT_EQ(decoded.stamp, reading.stamp);
  EXPECT_EQ(decoded.pressure_pa, reading.pressure_pa);
  EXPECT_NEAR(decoded.std_pa, reading.std_pa, 1e-15);
}

}  // namespace
}  // namespace patrol::sim::barometer_test
