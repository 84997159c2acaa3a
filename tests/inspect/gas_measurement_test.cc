#include "inspect/gas_measurement.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/random.h"

namespace patrol::inspect::gas_measurement_test {
namespace {

constexpr double kExactTol = 1e-9;
constexpr double kInf = std::numeric_limits<double>::infinity();

GasReading reading(int tick, double column_ppm_m, double path_length_m = 5.0) {
  return {.stamp = from_seconds(0.1 * (tick + 1)),
          .column_ppm_m = column_ppm_m,
          .path_length_m = path_length_m,
          .mean_mg_m3 = 0.0};
}

// Readings 2, 4, 4, 4, 5, 5, 7, 9: mean 5, squares about it 9 + 1 + 1 + 1 + 0 + 0 + 4 + 16 = 32.
TEST(GasMeasurement, MeanAndStandardErrorOfEightReadingsAreTheTextbooks) {
  GasMeasurement gas;
  int tick = 0;
  for (const double column : {2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0}) gas.add(reading(tick++, column));
  EXPECT_EQ(gas.count(), 8);
  EXPECT_NEAR(gas.mean_ppm_m(), 5.0, kExactTol);
  EXPECT_NEAR(gas.standard_error_ppm_m(), std::sqrt(32.0 / 7.0 / 8.0), kExactTol);
}

// 4000 normal readings: mean and standard error of the mean to four of their own standard deviations.
TEST(GasMeasurement, OfNormalReadingsFindsMeanAndStandardError) {
  constexpr int kReadings = 4000;
  constexpr double kMean = 180.0, kStd = 25.0;
  const RandomStream stream(5, "test/gas");
  GasMeasurement gas;
  for (int i = 0; i < kReadings; ++i) gas.add(reading(i, kMean + kStd * stream.normal(static_cast<std::uint64_t>(i))));
  const double standard_error = kStd / std::sqrt(kReadings);
  EXPECT_NEAR(gas.mean_ppm_m(), kMean, 4.0 * standard_error);
  EXPECT_NEAR(gas.standard_error_ppm_m(), standard_error, 4.0 * standard_error / std::sqrt(2.0 * kReadings));
}

// Squares of 10^9 would lose a spread of 1 if they were summed without taking the mean off.
TEST(GasMeasurement, KeepsASmallSpreadOnALargeMean) {
  GasMeasurement gas;
  for (int i = 0; i < 100; ++i) gas.add(reading(i, 1e9 + (i % 2 == 0 ? 1.0 : -1.0)));
  EXPECT_NEAR(gas.standard_error_ppm_m(), std::sqrt(100.0 / 99.0 / 100.0), 1e-6);
}

TEST(GasMeasurement, AReadingCountsOnce) {
  GasMeasurement gas;
  gas.add(reading(0, 100.0));
  gas.add(reading(0, 100.0));
  gas.add(reading(1, 200.0));
  gas.add(reading(0, 900.0));  // older than what is known
  EXPECT_EQ(gas.count(), 2);
  EXPECT_NEAR(gas.mean_ppm_m(), 150.0, kExactTol);
}

TEST(GasMeasurement, SkipsReadingsThatAreNoNumber) {
  GasMeasurement gas;
  gas.add(reading(0, std::nan("")));
  gas.add(reading(1, kInf));
  gas.add(reading(2, 70.0));
  EXPECT_EQ(gas.count(), 1);
  EXPECT_NEAR(gas.mean_ppm_m(), 70.0, kExactTol);
}

TEST(GasMeasurement, ReadingsWithoutAReturnDoNotCount) {
  GasMeasurement gas;
  for (int i = 0; i < 8; ++i) gas.add(reading(i, i % 2 == 0 ? 300.0 : 0.0, i % 2 == 0 ? 5.0 : kInf));
  gas.add(reading(8, 0.0, std::nan("")));
  EXPECT_EQ(gas.count(), 4);
  EXPECT_NEAR(gas.mean_ppm_m(), 300.0, kExactTol);
  EXPECT_EQ(gas.standard_error_ppm_m(), 0.0);
}

TEST(GasMeasurement, BeamLengthIsTheMeanOverEchoes) {
  GasMeasurement gas;
  EXPECT_FALSE(gas.beam_m());
  gas.add(reading(0, 1.0, kInf));
  EXPECT_FALSE(gas.beam_m());
  gas.add(reading(1, 1.0, 4.0));
  gas.add(reading(2, 1.0, 5.0));
  ASSERT_TRUE(gas.beam_m());
  EXPECT_NEAR(*gas.beam_m(), 4.5, kExactTol);
}

TEST(GasMeasurement, OfNothingOrOneReadingHasNoSpread) {
  GasMeasurement gas;
  EXPECT_EQ(gas.count(), 0);
  EXPECT_EQ(gas.standard_error_ppm_m(), 0.0);
  gas.add(reading(0, 42.0));
  EXPECT_EQ(gas.mean_ppm_m(), 42.0);
  EXPECT_EQ(gas.standard_error_ppm_m(), 0.0);
}

}  // namespace
}  // namespace patrol::inspect::gas_measurement_test
