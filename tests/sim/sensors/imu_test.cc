#include "sim/sensors/imu.h"

#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "tests/sim/small_world.h"

namespace patrol::sim::imu_test {
namespace {

constexpr double kTick_s = 0.002;
const std::string kBox = R"(<body><freejoint/><geom size="0.1"/><site name="imu"/></body>)";

ImuSettings ideal() {
  ImuSettings settings;
  settings.gyro_noise_density_radps_per_sqrt_hz = settings.gyro_bias_std_radps =
      settings.gyro_bias_random_walk_radps_per_sqrt_s = 0.0;
  settings.accel_noise_density_mps2_per_sqrt_hz = settings.accel_bias_std_mps2 =
      settings.accel_bias_random_walk_mps2_per_sqrt_s = 0.0;
  settings.scale_error_std = settings.misalignment_std_deg = 0.0;
  settings.gyro_resolution_radps = settings.accel_resolution_mps2 = 0.0;
  return settings;
}

/// Readings of a sensor at rest on one axis of the gyroscope and of the accelerometer, [tick].
struct Record {
  std::vector<double> gyro, accel;
};

Record record_at_rest(const ImuSettings& settings, int ticks, std::uint64_t seed) {
  const SmallWorld world(kBox);
  ImuSensor imu(settings, *world.model, seed);
  Record record;
  for (int tick = 0; tick < ticks; ++tick) {
    const Imu reading =
        imu.corrupt(Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Time{}, static_cast<std::uint64_t>(tick));
    record.gyro.push_back(reading.angular_velocity_radps.x());
    record.accel.push_back(reading.linear_acceleration_mps2.x());
  }
  return record;
}

/// Overlapping Allan deviation at an averaging time of `window` ticks (IEEE Std 952, annex C).
double allan_deviation(const std::vector<double>& rate, std::size_t window) {
  std::vector<double> angle(1, 0.0);
  for (const double value : rate) angle.push_back(angle.back() + value * kTick_s);
  const double tau = static_cast<double>(window) * kTick_s;
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i + 2 * window < angle.size(); ++i, ++count) {
    const double difference = angle[i + 2 * window] - 2.0 * angle[i + window] + angle[i];
    sum += difference * difference;
  }
  return std::sqrt(sum / static_cast<double>(count) / (2.0 * tau * tau));
}

TEST(Imu, WhiteNoiseAloneHasAnAllanDeviationOfNOverRootTau) {
  ImuSettings settings = ideal();
  settings.gyro_noise_density_radps_per_sqrt_hz = 2.3e-4;
  settings.accel_noise_density_mps2_per_sqrt_hz = 0.002;
  const Record record = record_at_rest(settings, 200000, 1);
  for (const std::size_t window : {5u, 50u, 500u}) {
    const double root_tau = std::sqrt(static_cast<double>(window) * kTick_s);
    EXPECT_NEAR(allan_deviation(record.gyro, window), 2.3e-4 / root_tau, 0.06 * 2.3e-4 / root_tau) << window;
    EXPECT_NEAR(allan_deviation(record.accel, window), 0.002 / root_tau, 0.06 * 0.002 / root_tau) << window;
  }
}

TEST(Imu, TheBiasWalkAloneHasAnAllanDeviationOfKTimesRootTauOver3) {
  ImuSettings settings = ideal();
  settings.gyro_bias_random_walk_radps_per_sqrt_s = 1.0e-5;
  settings.accel_bias_random_walk_mps2_per_sqrt_s = 1.0e-4;
  const Record record = record_at_rest(settings, 300000, 2);
  for (const std::size_t window : {250u, 1000u}) {
    const double root = std::sqrt(static_cast<double>(window) * kTick_s / 3.0);
    EXPECT_NEAR(allan_deviation(record.gyro, window), 1.0e-5 * root, 0.12 * 1.0e-5 * root) << window;
    EXPECT_NEAR(allan_deviation(record.accel, window), 1.0e-4 * root, 0.12 * 1.0e-4 * root) << window;
  }
}

TEST(Imu, WithTheDefaultsNoiseRulesAt1SecondAndTheWalkCanBeSeenAt100) {
  ImuSettings settings;
  settings.gyro_bias_random_walk_radps_per_sqrt_s = 1.0e-4;  // ten times the default, so that ten minutes show it
  const Record record = record_at_rest(settings, 300000, 3);
  const double quantisation = settings.gyro_resolution_radps / std::sqrt(12.0) * std::sqrt(kTick_s);  // as white noise
  const auto expected = [&](double tau) {
    return std::sqrt((2.3e-4 * 2.3e-4 + quantisation * quantisation) / tau + 1.0e-8 * tau / 3.0);
  };
  EXPECT_NEAR(allan_deviation(record.gyro, 500), expected(1.0), 0.10 * expected(1.0));
  EXPECT_NEAR(allan_deviation(record.gyro, 10000), expected(20.0), 0.35 * expected(20.0));
}

/// One figure of many sensors, each of its own seed.
test::Moments over_seeds(const ImuSettings& settings, const std::function<double(ImuSensor&)>& figure) {
  const SmallWorld world(kBox);
  test::Moments moments;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    ImuSensor imu(settings, *world.model, seed);
    moments.add(figure(imu));
  }
  return moments;
}

TEST(Imu, TheConstantBiasOf2000SensorsSpreadsBy2MilliradiansAnd30MillimetresPerSquareSecond) {
  ImuSettings settings = ideal();
  settings.gyro_bias_std_radps = 0.002;
  settings.accel_bias_std_mps2 = 0.03;
  const auto rest = [](ImuSensor& imu) { return imu.corrupt({0, 0, 0}, {0, 0, 0}, Time{}, 0); };
  const test::Moments gyro = over_seeds(settings, [&](ImuSensor& imu) { return rest(imu).angular_velocity_radps.z(); });
  const test::Moments accel =
      over_seeds(settings, [&](ImuSensor& imu) { return rest(imu).linear_acceleration_mps2.y(); });
  EXPECT_NEAR(gyro.std(), 0.002, 0.05 * 0.002);
  EXPECT_NEAR(gyro.mean(), 0.0, 4.0 * 0.002 / std::sqrt(2000.0));
  EXPECT_NEAR(accel.std(), 0.03, 0.05 * 0.03);
}

TEST(Imu, ScaleSpreadsBy1PerMilleAndMisalignmentBy0_05Degrees) {
  ImuSettings settings = ideal();
  settings.scale_error_std = 0.001;
  settings.misalignment_std_deg = 0.05;
  const auto turned = [](ImuSensor& imu) { return imu.corrupt({1, 0, 0}, {10, 0, 0}, Time{}, 0); };
  const test::Moments scale =
      over_seeds(settings, [&](ImuSensor& imu) { return turned(imu).angular_velocity_radps.x() - 1.0; });
  const test::Moments skew =
      over_seeds(settings, [&](ImuSensor& imu) { return turned(imu).linear_acceleration_mps2.z() / 10.0; });
  EXPECT_NEAR(scale.std(), 0.001, 0.05 * 0.001);
  EXPECT_NEAR(skew.std(), to_rad(0.05), 0.05 * to_rad(0.05));
}

TEST(Imu, ReadingsAreWholeStepsOfTheResolution) {
  const Record record = record_at_rest({}, 1000, 4);
  for (const double value : record.gyro) EXPECT_NEAR(std::remainder(value, 7.0e-4), 0.0, 1e-12);
  for (const double value : record.accel) EXPECT_NEAR(std::remainder(value, 0.0082), 0.0, 1e-12);
}

TEST(Imu, SaturatesAt17_4RadiansPerSecondAnd176MetresPerSquareSecond) {
  const SmallWorld world(kBox);
  ImuSensor imu(ideal(), *world.model, 1);
  const Imu reading = imu.corrupt({20, -20, 17}, {200, -200, 100}, Time{}, 0);
  EXPECT_EQ(reading.angular_velocity_radps, Eigen::Vector3d(17.4, -17.4, 17));
  EXPECT_EQ(reading.linear_acceleration_mps2, Eigen::Vector3d(176, -176, 100));
}

TEST(Imu, SwitchingTheBiasOffLeavesNoiseAndWalkAsTheyWere) {
  ImuSettings all;
  all.gyro_resolution_radps = all.accel_resolution_mps2 = 0.0;
  ImuSettings unbiased = all;
  unbiased.gyro_bias_std_radps = unbiased.accel_bias_std_mps2 = 0.0;
  const Record with = record_at_rest(all, 500, 6), without = record_at_rest(unbiased, 500, 6);
  for (std::size_t i = 0; i < with.gyro.size(); ++i) {
    EXPECT_NEAR(with.gyro[i] - without.gyro[i], with.gyro[0] - without.gyro[0], 1e-12);
    EXPECT_NEAR(with.accel[i] - without.accel[i], with.accel[0] - without.accel[0], 1e-12);
  }
}

TEST(Imu, AtRestItReadsGravityUpwardsAndFallingFreelyNothing) {
  SmallWorld falling(kBox);
  ImuSensor in_fall(ideal(), *falling.model, 1);
  EXPECT_NEAR(in_fall.read(*falling.model, *falling.data, Time{}, 0).linear_acceleration_mps2.norm(), 0.0, 1e-9);

  SmallWorld standing(
      R"(<body><joint type="slide" axis="1 0 0"/><geom size="0.1"/><site name="imu" euler="30 0 0"/></body>)");
  ImuSensor at_rest(ideal(), *standing.model, 1);
  const Imu reading = at_rest.read(*standing.model, *standing.data, Time{}, 0);
  const double roll = to_rad(30.0);
  EXPECT_NEAR((reading.linear_acceleration_mps2 - 9.81 * Eigen::Vector3d(0, std::sin(roll), std::cos(roll))).norm(),
              0.0, 1e-9);
}

TEST(Imu, OnAnArmOfHalfAMetreAt4RadiansPerSecondItReads8MetresPerSquareSecondInwards) {
  SmallWorld arm(R"(<body><joint axis="0 0 1"/><geom size="0.1"/><site name="imu" pos="0.5 0 0"/></body>)");
  arm.data->qvel[0] = 4.0;
  mj_forward(arm.model.get(), arm.data.get());
  ImuSensor imu(ideal(), *arm.model, 1);
  const Imu reading = imu.read(*arm.model, *arm.data, Time{}, 0);
  EXPECT_NEAR((reading.angular_velocity_radps - Eigen::Vector3d(0, 0, 4)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((reading.linear_acceleration_mps2 - Eigen::Vector3d(-8, 0, 9.81)).norm(), 0.0, 1e-9);
}

// The ground truth of the calibration is the bias that the sensor has.
TEST(Imu, ConstantBiasesAreThoseOfTheReadings) {
  ImuSettings settings = ideal();
  settings.gyro_bias_std_radps = 0.002;
  settings.accel_bias_std_mps2 = 0.03;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Record record = record_at_rest(settings, 1, seed);
    const ImuErrors constant = ImuSensor::constant_biases(settings, seed);
    EXPECT_NE(constant.gyro.bias.x(), 0.0);
    EXPECT_EQ(record.gyro[0], constant.gyro.bias.x()) << seed;
    EXPECT_EQ(record.accel[0], constant.accel.bias.x()) << seed;
  }
}

}  // namespace
}  // namespace patrol::sim::imu_test
