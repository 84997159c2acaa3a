// Water ahead of the face, instrument and inversion together: the simulator's TEM (sim/sensors/tem.h), its gains,
// shift, steel and noise, on a mount whose angles are off, against the robot's inversion, which knows none of them.
// Without physics: the antenna is where it is put.
//
// Rock of 0.002 to 0.005 S/m, a body of 5 to 7 m in radius 12 to 20 m from the antenna, up to 20 degrees aside and 12
// up or down, of a conductivity drawn from what the robot believes (0.6 S/m, 20 %).

#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "inspect/water/water_inversion.h"
#include "sim/sensors/tem.h"
#include "tests/support/soundings.h"

namespace patrol::water_ahead_test {
namespace {

constexpr int kSeeds = 10;

struct Truth {
  double rock_spm = 0.0;
  Eigen::Vector3d p_body = Eigen::Vector3d::Zero();  ///< of the water; the robot stands at the origin of world
  ConductiveSphere sphere;                           ///< as the antenna sees it
};

Truth draw_truth(const inspect::WaterPriorSettings& prior, std::uint64_t seed) {
  RandomSequence random(RandomStream(seed, "test/truth"), 0);
  const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  Truth truth{.rock_spm = between(0.002, 0.005),
              .sphere = {.distance_m = between(12.0, 20.0), .radius_m = between(5.0, 7.0)}};
  truth.sphere.conductivity_spm = prior.water_spm * std::exp(prior.water_log_std * random.normal());
  const double azimuth = between(-20.0, 20.0) * kDegree, elevation = between(-12.0, 12.0) * kDegree;
  const Eigen::Vector3d towards = quaternion_from_rpy(0.0, -elevation, azimuth) * Eigen::Vector3d::UnitX();
  truth.p_body = test::antenna_mount().T_body_mount.position + truth.sphere.distance_m * towards;
  return truth;
}

/// Ground that is drawn from the ranges that sim/subsurface.h documents, not from the inversion's prior.
struct RealGround {
  sim::RockSettings rock;
  sim::WaterBodySettings body;
  double distance_m = 0.0;                           ///< of the body's center from the antenna
  Eigen::Vector3d p_body = Eigen::Vector3d::Zero();  ///< of the water; the robot stands at the origin of world
};

/// Limestone of 0.0005 to 0.005 S/m; mud and mineralized water of 0.3 to 1 S/m, both uniform in the logarithm; a
/// spheroid of aspect ratio 1/2 to 2 in any attitude, with the volume of a sphere of 4 to 7 m, 12 to 20 m from the
/// antenna, up to 20 degrees aside and 12 up or down; a tunnel of 5.5 m radius; in every second ground a fault zone of
/// 0.002 to 0.02 S, 5 to 15 m ahead, up to 40 degrees oblique.
RealGround draw_ground(std::uint64_t seed) {
  RandomSequence random(RandomStream(seed, "test/truth"), 0);
  const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  const auto log_between = [&](double low, double high) { return low * std::pow(high / low, random.uniform()); };
  RealGround ground;
  ground.rock.conductivity_spm = log_between(0.0005, 0.005);
  ground.rock.tunnel_radius_m = 5.5;
  ground.rock.tunnel_air_fraction = 0.75;
  ground.distance_m = between(12.0, 20.0);
  ground.body.radius_m = between(4.0, 7.0);
  ground.body.conductivity_spm = log_between(0.3, 1.0);
  ground.body.shape = "spheroid";
  ground.body.aspect_ratio = log_between(0.5, 2.0);
  const double azimuth = between(-20.0, 20.0) * kDegree, elevation = between(-12.0, 12.0) * kDegree;
  const Eigen::Vector3d towards = quaternion_from_rpy(0.0, -elevation, azimuth) * Eigen::Vector3d::UnitX();
  ground.p_body = test::antenna_mount().T_body_mount.position + ground.distance_m * towards;
  ground.body.x_m = ground.p_body.x(), ground.body.y_m = ground.p_body.y(), ground.body.z_m = ground.p_body.z();
  ground.body.axis_azimuth_deg = between(-180.0, 180.0);
  ground.body.axis_elevation_deg = std::asin(between(-1.0, 1.0)) / kDegree;
  const double zone_ahead_m = between(5.0, 15.0), zone_azimuth_deg = between(-40.0, 40.0),
               conductance_s = log_between(0.002, 0.02);
  if (random.uniform() < 0.5) {
    ground.rock.fault_zone.conductance_s = conductance_s;
    ground.rock.fault_zone.x_m = test::antenna_mount().T_body_mount.position.x() + zone_ahead_m;
    ground.rock.fault_zone.normal_azimuth_deg = zone_azimuth_deg;
  }
  return ground;
}

/// The robot's soundings: the coil is off by 0.3 deg all the time and by 0.2 deg from pose to pose; the servos read
/// what was asked.
WaterResult sound_and_invert(const sim::RockSettings& rock, const std::vector<sim::WaterBodySettings>& water,
                             std::uint64_t seed) {
  // Half of the robot's own particles and moves, for the sake of the test's seconds.
  inspect::WaterSettings settings;
  settings.particles = 250;
  settings.mcmc_steps = 4;
  const AntennaGeometry antenna = test::antenna_mount();
  const sim::Tem tem({}, rock, water, seed);
  RandomSequence error(RandomStream(seed, "test/angles"), 0);
  const double yaw_off = 0.3 * kDegree * error.normal(), pitch_off = 0.3 * kDegree * error.normal();
  std::vector<inspect::OrientedSounding> soundings;
  for (const inspect::AntennaPose& pose : inspect::antenna_poses(settings.sounding, antenna)) {
    const Pose3 T_world_tem = antenna.T_body_tem(pose.yaw_rad + yaw_off + 0.2 * kDegree * error.normal(),
                                                 pose.pitch_rad + pitch_off + 0.2 * kDegree * error.normal());
    const Eigen::Vector3d axis = T_world_tem.rotation * Eigen::Vector3d::UnitX();
    const auto count = static_cast<std::uint64_t>(soundings.size());
    soundings.push_back({pose, tem.sound(T_world_tem.position, axis * axis.transpose(), count,
                                         from_seconds(static_cast<double>(count)))});
  }
  return inspect::WaterInversion(settings).invert(soundings, antenna, {}, 0.0, seed);
}

WaterResult sound_and_invert(const Truth& truth, bool has_water, std::uint64_t seed) {
  std::vector<sim::WaterBodySettings> water;
  if (has_water) {
    water.push_back(
        {truth.p_body.x(), truth.p_body.y(), truth.p_body.z(), truth.sphere.radius_m, truth.sphere.conductivity_spm});
  }
  return sound_and_invert({.conductivity_spm = truth.rock_spm}, water, seed);
}

TEST(WaterAhead, IsLocatedWithinTwoMetresInNineOfTenSeedsAndTheIntervalsHoldTheTruthInEight) {
  int located = 0, distance_in_interval = 0, radius_in_interval = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Truth truth = draw_truth({}, seed);
    const WaterResult result = sound_and_invert(truth, true, seed);
    const double error_m = (result.p_map - truth.p_body).norm();
    located += result.is_found && error_m < 2.0 ? 1 : 0;
    distance_in_interval +=
        truth.sphere.distance_m >= result.distance_low_m && truth.sphere.distance_m <= result.distance_high_m ? 1 : 0;
    radius_in_interval +=
        truth.sphere.radius_m >= result.radius_low_m && truth.sphere.radius_m <= result.radius_high_m ? 1 : 0;
    std::printf(
        "seed %2d: evidence %6.1f, %5.2f m from the truth; distance %5.2f m (%5.2f ... %5.2f), radius %4.2f m (%4.2f "
        "... %4.2f)\n",
        static_cast<int>(seed), result.evidence, error_m, truth.sphere.distance_m, result.distance_low_m,
        result.distance_high_m, truth.sphere.radius_m, result.radius_low_m, result.radius_high_m);
  }
  EXPECT_GE(located, 9);
  // Of ten intervals of 95 %, fewer than eight hold in 1 of 90 such tests.
  EXPECT_GE(distance_in_interval, 8);
  EXPECT_GE(radius_in_interval, 8);
}

TEST(WaterAhead, NoneIsReportedInTenSeedsWhereThereIsNone) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const WaterResult result = sound_and_invert(draw_truth({}, seed), false, seed);
    EXPECT_FALSE(result.is_found) << "seed " << seed << ", evidence " << result.evidence;
    EXPECT_LT(result.evidence, 2.0) << "seed " << seed << ": far from the threshold of 5";
  }
}

// The inversion's sphere in homogeneous rock is not the ground. Its 95 % intervals hold the distance in 6 and the
// radius in 8 of these ten: too few for the distance (fewer than seven in 1 of 1000 such tests). The bounds are those
// measured, so that the test fails when it becomes worse; worlds/tunnel/README.md has the figures and the reasons.
TEST(WaterAhead, InRealGroundEveryBodyIsFoundAndEightOfTenAreLocatedWithinTwoMeters) {
  int found = 0, located = 0, distance_in_interval = 0, radius_in_interval = 0;
  for (std::uint64_t seed = 101; seed <= 110; ++seed) {
    const RealGround ground = draw_ground(seed);
    const WaterResult result = sound_and_invert(ground.rock, {ground.body}, seed);
    const double error_m = (result.p_map - ground.p_body).norm(), radius_m = ground.body.radius_m;
    found += result.is_found ? 1 : 0;
    located += result.is_found && error_m < 2.0 ? 1 : 0;
    distance_in_interval +=
        ground.distance_m >= result.distance_low_m && ground.distance_m <= result.distance_high_m ? 1 : 0;
    radius_in_interval += radius_m >= result.radius_low_m && radius_m <= result.radius_high_m ? 1 : 0;
  }
  EXPECT_EQ(found, 10);
  EXPECT_GE(located, 8);
  EXPECT_GE(distance_in_interval, 6);
  EXPECT_GE(radius_in_interval, 8);
}

}  // namespace
}  // namespace patrol::water_ahead_test
