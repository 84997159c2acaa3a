#include "sim/locomotion/leg_gains.h"

#include <cmath>
#include <string>
#include <vector>

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
  const LegScale scale = leg_scale(robot);
  EXPECT_EQ(scale.length, 1.0);
  EXPECT_EQ(scale.time, 1.0);
  EXPECT_EQ(scale.force, 1.0);
  const LegGains gains = scaled_leg_gains(robot), defaults;
  EXPECT_EQ(gains.height_stiffness, defaults.height_stiffness);
  EXPECT_EQ(gains.swing_damping_nspm, defaults.swing_damping_nspm);
  EXPECT_EQ(gains.inertia_per_kg_m2, defaults.inertia_per_kg_m2);
  const LocomotionSettings settings = scaled_locomotion(robot), tuned;
  EXPECT_EQ(settings.trunk_height_m, tuned.trunk_height_m);
  EXPECT_EQ(settings.gait_period_s, tuned.gait_period_s);
  EXPECT_EQ(settings.max_yaw_acceleration_radps2, tuned.max_yaw_acceleration_radps2);
}

TEST(LegGains, OfLegsFourTimesAsLongHaveTwiceThePeriodAndAQuarterOfTheStiffnessPerMass) {
  RobotDescription robot = io::load_robot_description(kRobotUrdf);
  for (LegGeometry& leg : robot.legs) leg.thigh_m *= 4.0, leg.shank_m *= 4.0, leg.hip_in_body *= 4.0;
  robot.mass_kg *= 3.0;
  const LegGains gains = scaled_leg_gains(robot), defaults;
  EXPECT_NEAR(gains.height_stiffness, defaults.height_stiffness / 4.0, 1e-9);
  EXPECT_NEAR(gains.height_damping, defaults.height_damping / 2.0, 1e-9);
  EXPECT_NEAR(gains.max_step_m, 0.8, 1e-9);
  EXPECT_NEAR(gains.touch_force_n, 36.0, 1e-9);
  EXPECT_NEAR(gains.swing_stiffness_npm, 700.0 * 3.0 / 4.0, 1e-9);
  const LocomotionSettings settings = scaled_locomotion(robot);
  EXPECT_NEAR(settings.gait_period_s, 0.72, 1e-9);
  EXPECT_NEAR(settings.max_forward_mps, 2.0, 1e-9);
  EXPECT_NEAR(settings.trunk_height_m, 1.2, 2e-3);
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

struct Walker {
  std::string name;
  UrdfQuadruped robot;
};

void PrintTo(const Walker& walker, std::ostream* out) { *out << walker.name; }

std::vector<Walker> walkers() {
  std::vector<Walker> all = {{"kg_8_leg_0_32_m", of_size(8.0, 0.32)}, {"kg_15_leg_0_42_m", of_size(15.0, 0.42)},
                             {"kg_30_leg_0_6_m", of_size(30.0, 0.6)}, {"kg_60_leg_0_8_m", of_size(60.0, 0.8)},
                             {"actuator_frames", of_size(25.0, 0.5)}, {"hip_first", of_size(25.0, 0.5)},
                             {"knees_forward", of_size(25.0, 0.5)}};
  all[4].robot.frames = test::actuator_frames();
  all[4].robot.knee_offset_m = 0.03;
  all[5].robot.is_hip_first = true;
  all[6].robot.knee_lower_rad = 0.3;
  all[6].robot.knee_upper_rad = 2.7;
  return all;
}

class Walkers : public testing::TestWithParam<Walker> {
 protected:
  Walkers() : urdf_("walker.urdf", GetParam().robot.text()), description_(io::load_robot_description(urdf_.path())) {}
  WalkingRobot robot() const {
    const test::TemporaryFile world("world.xml", make_flat_world());
    return WalkingRobot(assemble_model(world.path(), urdf_.path(), description_, {}), description_, 1, settings());
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

TEST_P(Walkers, WalkAndTurnWithin10PercentAndKeepTheTrunkWithin18Degrees) {
  const LocomotionSettings limits = settings();
  struct Command {
    double forward, sideways, turn;  ///< of the maximum
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
    EXPECT_LT(report.max_tilt_rad, 18.0 * kDegree);
    EXPECT_LT(report.roll_rms_rad, 9.0 * kDegree);
    EXPECT_LT(report.pitch_rms_rad, 1.5 * kDegree);
    EXPECT_LT(report.max_torque_nm, 0.95 * GetParam().robot.knee_effort_nm);
    EXPECT_FALSE(report.has_fallen);
    const WalkReport stop = walker.stand(3.0);
    EXPECT_FALSE(stop.has_fallen);
    EXPECT_LT(walker.velocity_mps().norm(), 0.05);
  }
}

INSTANTIATE_TEST_SUITE_P(LegGains, Walkers, testing::ValuesIn(walkers()),
                         [](const auto& walker) { return walker.param.name; });

}  // namespace
}  // namespace patrol::sim::leg_gains_test
