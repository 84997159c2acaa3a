#include "sim/locomotion/leg_gains.h"

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "io/urdf.h"
#include "tests/support/legged_urdf.h"
#include "tests/support/simulated_quadruped.h"
#include "tests/support/temporary_file.h"

namespace patrol::sim::leg_gains_test {
namespace {

using test::UrdfQuadruped;

TEST(LegGains, OfTheTunedRobotAreTheDefaultsExactly) {
  const RobotDescription robot = io::load_robot_description(kRobotUrdf);
  const LegGains gains = scaled_leg_gains(robot), defaults;
  EXPECT_EQ(gains.height_stiffness, defaults.height_stiffness);
  EXPECT_EQ(gains.swing_damping_nspm, defaults.swing_damping_nspm);
  EXPECT_EQ(gains.inertia_per_kg_m2, defaults.inertia_per_kg_m2);
  EXPECT_EQ(gains.center_m, Eigen::Vector3d::Zero());
  EXPECT_EQ(gains.velocity_time_s, defaults.velocity_time_s);
  const LocomotionSettings settings = scaled_locomotion(robot), tuned;
  EXPECT_EQ(settings.trunk_height_m, tuned.trunk_height_m);
  EXPECT_EQ(settings.gait_period_s, tuned.gait_period_s);
  EXPECT_EQ(settings.max_yaw_acceleration_radps2, tuned.max_yaw_acceleration_radps2);
}

TEST(LegGains, OfLegsFourTimesAsLongHaveTwiceThePeriodAndAQuarterOfTheStiffnessPerMass) {
  RobotDescription robot = io::load_robot_description(kRobotUrdf);
  for (LegGeometry& leg : robot.legs) leg.thigh_m *= 4.0, leg.shank_m *= 4.0, leg.hip_in_body *= 4.0;
  robot.mass_kg *= 3.0;
  robot.standing_inertia_kgm2 *= 3.0 * 4.0 * 4.0;
  for (JointLimit& limit : robot.joint_limits) limit.effort_nm *= 3.0 * 4.0 * 4.0;
  const LegGains gains = scaled_leg_gains(robot), defaults;
  EXPECT_NEAR(gains.height_stiffness, defaults.height_stiffness / 4.0, 1e-9);
  EXPECT_NEAR(gains.height_damping, defaults.height_damping / 2.0, 1e-9);
  EXPECT_NEAR(gains.max_step_m, 0.8, 1e-9);
  EXPECT_NEAR(gains.touch_force_n, 36.0, 1e-9);
  // The rotors count as those of motors of 3 x 12 times the torque: 0.73 x 36 / 16 + 0.27 x 3.
  EXPECT_NEAR(gains.swing_stiffness_npm, 700.0 * 2.45 / 4.0, 1e-9);
  EXPECT_NEAR(gains.swing_damping_nspm, 16.0 * 2.45 / 2.0, 1e-9);
  EXPECT_NEAR(gains.velocity_time_s, 0.04, 1e-9);
  const LocomotionSettings settings = scaled_locomotion(robot);
  EXPECT_NEAR(settings.gait_period_s, 0.72, 1e-9);
  EXPECT_NEAR(settings.max_forward_mps, 2.0, 1e-9);
  EXPECT_EQ(settings.moment_arm_m, settings.trunk_height_m);
  EXPECT_NEAR(settings.trunk_height_m, 1.2, 2e-3);
}

// 73 % of the inertia of the tuned leg at its foot are rotors, whose inertia is proportional to the torque limit.
TEST(LegGains, OfMotorsTwiceAsStrongHave1_73TimesTheDampingOfASwingFootAndTheSameStiffness) {
  RobotDescription robot = io::load_robot_description(kRobotUrdf);
  for (JointLimit& limit : robot.joint_limits) limit.effort_nm *= 2.0;
  const LegGains gains = scaled_leg_gains(robot), defaults;
  EXPECT_NEAR(gains.swing_damping_nspm, 1.73 * defaults.swing_damping_nspm, 1e-9);
  EXPECT_EQ(gains.swing_stiffness_npm, defaults.swing_stiffness_npm);
}

TEST(LegGains, OfMotorsHalfAsStrongHave0_64TimesTheDampingAndTheStiffnessOfASwingFoot) {
  RobotDescription robot = io::load_robot_description(kRobotUrdf);
  for (JointLimit& limit : robot.joint_limits) limit.effort_nm *= 0.5;
  const LegGains gains = scaled_leg_gains(robot), defaults;  // 0.73 / 2 + 0.27, rounded
  EXPECT_NEAR(gains.swing_damping_nspm, 0.64 * defaults.swing_damping_nspm, 1e-9);
  EXPECT_NEAR(gains.swing_stiffness_npm, 0.64 * defaults.swing_stiffness_npm, 1e-9);
}

/// Robot with legs of a length and a mass; torques are proportional to both.
UrdfQuadruped of_size(double mass_kg, double leg_m) {
  UrdfQuadruped robot;
  robot.mass_kg = mass_kg;
  robot.thigh_m = robot.shank_m = 0.5 * leg_m;
  robot.hip_spacing_m = 0.9 * leg_m;
  robot.hip_width_m = 0.22 * leg_m;
  robot.abduction_offset_m = 0.19 * leg_m;
  robot.foot_radius_m = 0.047 * leg_m;
  robot.effort_nm = 4.1 * mass_kg * leg_m;
  robot.knee_effort_nm = 6.2 * mass_kg * leg_m;
  return robot;
}

/// Robots like small robot dogs: slender with light legs, with a strong trunk, and with strong motors.
UrdfQuadruped slender() {
  UrdfQuadruped robot = of_size(6.0, 0.36);
  robot.hip_spacing_m = 0.4;
  robot.hip_width_m = 0.1;
  robot.abduction_offset_m = 0.05;
  robot.leg_mass_ratio = 0.3;
  robot.effort_nm = 10.0;
  robot.knee_effort_nm = 15.0;
  return robot;
}

UrdfQuadruped small_dog(double mass_kg, double effort_nm, double abduction_offset_m) {
  UrdfQuadruped robot = of_size(mass_kg, 0.4);
  robot.hip_spacing_m = 0.38;
  robot.hip_width_m = 0.098;
  robot.abduction_offset_m = abduction_offset_m;
  robot.leg_mass_ratio = 0.55;
  robot.effort_nm = effort_nm;
  robot.knee_effort_nm = 1.5 * effort_nm;
  return robot;
}

/// Robot with a wide stance and light legs.
UrdfQuadruped wide(double mass_kg, double leg_m) {
  UrdfQuadruped robot = of_size(mass_kg, leg_m);
  robot.hip_spacing_m = 1.3 * leg_m;
  robot.hip_width_m = 0.45 * leg_m;
  robot.leg_mass_ratio = 0.3;
  return robot;
}

struct Walker {
  std::string name;
  UrdfQuadruped robot;
};

void PrintTo(const Walker& walker, std::ostream* out) { *out << walker.name; }

std::vector<Walker> walkers() {
  std::vector<Walker> all = {{"kg_8_leg_0_32_m", of_size(8.0, 0.32)},
                             {"kg_15_leg_0_42_m", of_size(15.0, 0.42)},
                             {"kg_30_leg_0_6_m", of_size(30.0, 0.6)},
                             {"kg_60_leg_0_8_m", of_size(60.0, 0.8)},
                             {"actuator_frames", of_size(25.0, 0.5)},
                             {"hip_first", of_size(25.0, 0.5)},
                             {"knees_forward", of_size(25.0, 0.5)},
                             {"kg_6_slender", slender()},
                             {"kg_8_dog", small_dog(8.0, 17.0, 0.062)},
                             {"kg_12_dog", small_dog(12.0, 33.5, 0.084)},
                             {"kg_60_wide", wide(60.0, 0.6)}};
  all[4].robot.frames = test::actuator_frames();
  all[4].robot.knee_offset_m = 0.03;
  all[5].robot.is_hip_first = true;
  all[6].robot.knee_lower_rad = 0.3;
  all[6].robot.knee_upper_rad = 2.7;
  return all;
}

WalkingRobot make_walker(const test::TemporaryFile& urdf, const RobotDescription& description,
                         const std::string& geoms = "", std::uint64_t seed = 1) {
  const test::TemporaryFile world("world.xml", make_flat_world(geoms));
  return WalkingRobot(assemble_model(world.path(), urdf.path(), description, {}), description, seed,
                      scaled_locomotion(description));
}

/// Box with an upper face of `length_m` that begins at (`from_x_m`, 0, `from_z_m`) and rises by an angle.
std::string board(double from_x_m, double from_z_m, double length_m, double angle_rad) {
  constexpr double kHalfThickness_m = 0.1;
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return fmt::format(R"(<geom type="box" size="{} 4 {}" pos="{} 0 {}" euler="0 {} 0"/>)", 0.5 * length_m,
                     kHalfThickness_m, from_x_m + 0.5 * length_m * c + kHalfThickness_m * s,
                     from_z_m + 0.5 * length_m * s - kHalfThickness_m * c, -to_deg(angle_rad));
}

/// Ramp up and down, 2 m each, with a level top of 1 m.
std::string ramp(double from_x_m, double angle_rad) {
  const double run_m = 2.0 * std::cos(angle_rad), rise_m = 2.0 * std::sin(angle_rad);
  return board(from_x_m, 0.0, 2.0, angle_rad) + board(from_x_m + run_m, rise_m, 1.0, 0.0) +
         board(from_x_m + run_m + 1.0, rise_m, 2.0, -angle_rad);
}

class Walkers : public testing::TestWithParam<Walker> {
 protected:
  Walkers() : urdf_("walker.urdf", GetParam().robot.text()), description_(io::load_robot_description(urdf_.path())) {}
  WalkingRobot robot(const std::string& geoms = "", std::uint64_t seed = 1) const {
    return make_walker(urdf_, description_, geoms, seed);
  }
  LocomotionSettings settings() const { return scaled_locomotion(description_); }

  test::TemporaryFile urdf_;
  RobotDescription description_;
};

TEST_P(Walkers, StandForFiveSecondsWithin2CentimetersAnd2Degrees) {
  WalkingRobot walker = robot();
  walker.stand(1.5);
  const WalkReport report = walker.stand(5.0);
  EXPECT_LT(report.moved.position().norm(), 0.02);
  EXPECT_LT(report.max_tilt_rad, 2.0 * kDegree);
  EXPECT_NEAR(report.min_height_m, description_.body_height_m(), 0.1 * description_.body_height_m());
  EXPECT_EQ(report.steps_taken, 0);
  EXPECT_FALSE(report.has_fallen);
}

TEST_P(Walkers, WalkAndTurnWithin10PercentAndKeepTheTrunkWithin9Degrees) {
  const LocomotionSettings limits = settings();
  struct Command {
    double forward, sideways, turn;  ///< fractions of the maximum
  };
  for (const auto [forward, sideways, turn] :
       {Command{0.8, 0, 0}, {-0.8, 0, 0}, {0, 0.8, 0}, {0, 0, 0.8}, {0.6, 0, 0.5}}) {
    SCOPED_TRACE(testing::Message() << forward << " " << sideways << " " << turn);
    const double vx = forward * (forward > 0.0 ? limits.max_forward_mps : limits.max_backward_mps),
                 vy = sideways * limits.max_sideways_mps, rate = turn * limits.max_yaw_rate_radps;
    WalkingRobot walker = robot();
    walker.stand(1.5);
    walker.walk(vx, vy, rate, 2.5);  // up to speed
    const WalkReport report = walker.walk(vx, vy, rate, 4.0);
    EXPECT_NEAR(report.mean_forward_mps, vx, 0.1 * std::abs(vx) + 0.03);
    EXPECT_NEAR(report.mean_sideways_mps, vy, 0.1 * std::abs(vy) + 0.05);
    EXPECT_NEAR(report.mean_yaw_rate_radps, rate, 0.1 * std::abs(rate) + 0.03);
    EXPECT_LT(report.max_tilt_rad, 9.0 * kDegree);
    EXPECT_LT(report.roll_rms_rad, 3.0 * kDegree);
    EXPECT_LT(report.pitch_rms_rad, 1.5 * kDegree);
    EXPECT_LT(report.max_torque_nm, 0.95 * GetParam().robot.knee_effort_nm);
    EXPECT_FALSE(report.has_fallen);
    const WalkReport stop = walker.stand(3.0);
    EXPECT_FALSE(stop.has_fallen);
    EXPECT_LT(walker.velocity_mps().norm(), 0.05);
  }
}

// With a moment arm of 1 m and forces that were only clipped, up to 24 degrees.
TEST_P(Walkers, CrossARampOf10DegreesAt0_6OfTheirMaximumSpeedWithin14Degrees) {
  for (const std::uint64_t seed : {31, 32}) {
    SCOPED_TRACE(seed);
    const double from_x_m = description_.outline_radius_m() + 0.7, speed_mps = 0.6 * settings().max_forward_mps;
    WalkingRobot walker = robot(ramp(from_x_m, 10.0 * kDegree), seed);
    walker.stand(1.5);
    const WalkReport report = walker.walk(speed_mps, 0.0, 0.0, (2.0 * from_x_m + 5.0) / speed_mps + 0.5);
    EXPECT_GT(report.moved.x, from_x_m + 4.95);
    EXPECT_LT(report.max_tilt_rad, 14.0 * kDegree);
    EXPECT_FALSE(report.has_fallen);
  }
}

INSTANTIATE_TEST_SUITE_P(LegGains, Walkers, testing::ValuesIn(walkers()),
                         [](const auto& walker) { return walker.param.name; });

double roll_rms_deg(const UrdfQuadruped& robot) {
  const test::TemporaryFile urdf("walker.urdf", robot.text());
  const RobotDescription description = io::load_robot_description(urdf.path());
  const double speed_mps = 0.6 * scaled_locomotion(description).max_forward_mps;
  WalkingRobot walker = make_walker(urdf, description);
  walker.stand(1.5);
  walker.walk(speed_mps, 0.0, 0.0, 3.0);
  return to_deg(walker.walk(speed_mps, 0.0, 0.0, 6.0).roll_rms_rad);
}

// Before, 6.0 and 1.8 degrees.
TEST(LegGains, RobotsOfOneShapeWith6And60KilogramsSwayByLessThan1_5DegreesRms) {
  for (const UrdfQuadruped& robot : {of_size(6.0, 0.3), of_size(60.0, 0.8)}) {
    EXPECT_LT(roll_rms_deg(robot), 1.5);
  }
}

}  // namespace
}  // namespace patrol::sim::leg_gains_test
