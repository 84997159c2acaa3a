#include "sim/sensors/magnetometer.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "io/ros/ros_messages.h"
#include "tests/sim/small_world.h"

namespace patrol::sim::magnetometer_test {
namespace {

constexpr std::uint64_t kReadings = 20000;

MagnetometerSettings ideal() {
  MagnetometerSettings settings;
  settings.hard_iron_std_t = settings.soft_iron_std = settings.noise_std_t = settings.resolution_t = 0.0;
  return settings;
}

/// A steel box of 1 m, centered 3 m east of the origin.
const std::string kSteelBox = R"(<geom name="steel_cabinet" type="box" pos="3 0 0" size="0.5 0.5 0.5"/>)";
const std::string kWoodenBox = R"(<geom name="wooden_cabinet" type="box" pos="3 0 0" size="0.5 0.5 0.5"/>)";

TEST(Magnetometer, LevelAndFacingEastItReadsTheGeomagneticFieldOfTheDefaults) {
  const SmallWorld world("");
  const Magnetometer magnetometer(ideal(), *world.model, 1);
  const Eigen::Vector3d field_t = magnetometer.read(*world.data, {}, Time{}, 0).field_t;
  EXPECT_NEAR(field_t.norm(), 4.87e-5, 1e-12);
  EXPECT_NEAR(std::atan2(-field_t.z(), field_t.head<2>().norm()), 45.0 * kDegree, 1e-9);
  EXPECT_NEAR(std::atan2(field_t.x(), field_t.y()), -5.6 * kDegree, 1e-9)
      << "declination: x of the body is east, y north";
}

TEST(Magnetometer, ATurnOfTheRobotTurnsTheReadingBack) {
  const SmallWorld world("");
  const Magnetometer magnetometer(ideal(), *world.model, 1);
  const Pose3 turned{Eigen::Vector3d::Zero(), quaternion_from_rpy(0.1, -0.2, 0.7)};
  const Eigen::Vector3d level = magnetometer.read(*world.data, {}, Time{}, 0).field_t;
  EXPECT_LT((turned.rotation * magnetometer.read(*world.data, turned, Time{}, 0).field_t - level).norm(), 1e-15);
}

TEST(Magnetometer, NoiseOfTheDefaultsIs410NanoteslaOnEachAxisAndIsStatedWithTheReading) {
  const SmallWorld world("");
  const Magnetometer magnetometer({}, *world.model, 3);
  std::array<test::Moments, 3> axes;
  for (std::uint64_t i = 0; i < kReadings; ++i) {
    const MagneticField reading = magnetometer.measure(Eigen::Vector3d::Zero(), Time{}, i);
    EXPECT_EQ(reading.std_t, 4.1e-7);
    for (int axis = 0; axis < 3; ++axis) axes[static_cast<std::size_t>(axis)].add(reading.field_t[axis]);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(axes[axis].std(), 4.1e-7, 0.02 * 4.1e-7);
    EXPECT_NEAR(axes[axis].mean(), magnetometer.hard_iron_t()[static_cast<int>(axis)],
                4.0 * 4.1e-7 / std::sqrt(kReadings));
  }
}

// reading = A field + b: the fields +-F e_i give b as the mean of a pair and the columns of A as half its difference.
TEST(Magnetometer, HardAndSoftIronOfTheDefaultsHaveTheirStandardDeviationsOverRobots) {
  const SmallWorld world("");
  MagnetometerSettings settings;
  settings.noise_std_t = settings.resolution_t = 0.0;
  test::Moments hard_t, diagonal, off_diagonal;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    const Magnetometer magnetometer(settings, *world.model, seed);
    constexpr double kField_t = 5e-5;
    Eigen::Matrix3d soft;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d field = kField_t * Eigen::Vector3d::Unit(axis);
      const Eigen::Vector3d plus = magnetometer.measure(field, Time{}, 0).field_t,
                            minus = magnetometer.measure(-field, Time{}, 0).field_t;
      soft.col(axis) = (plus - minus) / (2.0 * kField_t);
      hard_t.add(0.5 * (plus + minus)[axis]);
    }
    EXPECT_LT((soft - soft.transpose()).norm(), 1e-9);
    diagonal.add(soft(1, 1) - 1.0);
    off_diagonal.add(soft(0, 2));
  }
  EXPECT_NEAR(hard_t.std(), 1.0e-5, 0.05 * 1.0e-5);
  EXPECT_NEAR(diagonal.std(), 0.03, 0.07 * 0.03);
  EXPECT_NEAR(off_diagonal.std(), 0.03, 0.07 * 0.03);
}

TEST(Magnetometer, ReadingsOfTheDefaultsAreWholeStepsWithinFullScale) {
  const SmallWorld world("");
  const Magnetometer magnetometer({}, *world.model, 1);
  const double steps = magnetometer.measure({2e-5, 0.0, 0.0}, Time{}, 0).field_t.x() / 1.4616e-8;
  EXPECT_NEAR(steps, std::round(steps), 1e-6);
  EXPECT_EQ(magnetometer.measure({1e-2, 0.0, 0.0}, Time{}, 0).field_t.x(), 4.0e-4);
}

// A tenth of 1 m3 is a sphere of 0.288 m. On its axis along the field the dipole adds 2 (radius / distance)^3 of the
// field, across it takes away (radius / distance)^3.
TEST(Magnetometer, ASteelBoxAddsTheFieldOfItsInducedDipole) {
  const SmallWorld world(kSteelBox);
  MagnetometerSettings settings = ideal();
  settings.inclination_deg = 0.0;
  settings.declination_deg = 90.0;  // the field points east
  const Magnetometer magnetometer(settings, *world.model, 1);
  const double cube = 0.75 * 0.1 / std::numbers::pi;
  const double east = magnetometer.read(*world.data, {}, Time{}, 0).field_t.x();
  EXPECT_NEAR(east / 4.87e-5 - 1.0, 2.0 * cube / 27.0, 1e-9);
  const Pose3 north_of_it{{3.0, 2.0, 0.0}, Eigen::Quaterniond::Identity()};
  EXPECT_NEAR(magnetometer.read(*world.data, north_of_it, Time{}, 0).field_t.x() / 4.87e-5 - 1.0, -cube / 8.0, 1e-9);
}

TEST(Magnetometer, WoodAndSwitchedOffSteelDoNotDisturb) {
  MagnetometerSettings without = ideal();
  without.steel_fill = 0.0;
  const SmallWorld wood(kWoodenBox), steel(kSteelBox);
  const Magnetometer beside_wood(ideal(), *wood.model, 1), beside_steel(without, *steel.model, 1);
  EXPECT_NEAR(beside_wood.read(*wood.data, {}, Time{}, 0).field_t.norm(), 4.87e-5, 1e-15);
  EXPECT_NEAR(beside_steel.read(*steel.data, {}, Time{}, 0).field_t.norm(), 4.87e-5, 1e-15);
}

TEST(Magnetometer, TheMessageComesBackFromItsRosEncoding) {
  const MagneticField reading{.stamp = from_seconds(12.5), .field_t = {1e-5, -2e-5, 3e-5}, .std_t = 4.1e-7};
  const auto decoded = io::decode<MagneticField>(io::encode(reading));
  EXPECT_EQ(decoded.stamp, reading.stamp);
  EXPECT_EQ(decoded.field_t, reading.field_t);
  EXPECT_NEAR(decoded.std_t, reading.std_t, 1e-20);
}

}  // namespace
}  // namespace patrol::sim::magnetometer_test
