#include "sim/tem/subsurface_response.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "tests/support/moments.h"

namespace patrol::sim::subsurface_response_test {
namespace {

using ::testing::HasSubstr;

const Eigen::Vector3d kCoil(0.0, 0.0, 1.0);

const TemGates& gates() {
  static const TemGates kGates({.gate_s = {2e-6, 5e-6, 2e-5}});
  return kGates;
}

Eigen::VectorXd rate(const Subsurface& subsurface, const Eigen::Vector3d& axis = Eigen::Vector3d::UnitX()) {
  return SubsurfaceResponse(subsurface, gates()).gated_rate(kCoil, axis * axis.transpose());
}

WaterBodySettings spheroid(double aspect_ratio) {
  return {.x_m = 15.0,
          .y_m = 4.0,
          .z_m = 3.0,
          .shape = "spheroid",
          .aspect_ratio = aspect_ratio,
          .axis_azimuth_deg = 30.0,
          .axis_elevation_deg = 20.0};
}

TEST(SubsurfaceResponse, ASpheroidOfEqualAxesIsASphere) {
  WaterBodySettings sphere = spheroid(1.0);
  sphere.shape = "sphere";
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d::UnitX().eval(), Eigen::Vector3d(0.6, 0.0, -0.8)}) {
    const Eigen::VectorXd expected = rate({.water_bodies = {sphere}}, axis);
    EXPECT_LT((rate({.water_bodies = {spheroid(1.0)}}, axis) - expected).cwiseQuotient(expected).norm(), 2e-5);
  }
}

TEST(SubsurfaceResponse, AFlatBodyRespondsLongestThroughItsFlatSide) {
  WaterBodySettings lens = spheroid(0.5);
  lens.y_m = 0.0, lens.z_m = kCoil.z();
  lens.axis_azimuth_deg = lens.axis_elevation_deg = 0.0;
  const Eigen::VectorXd rock = rate({}), facing = rate({.water_bodies = {lens}}) - rock;
  lens.axis_azimuth_deg = 90.0;
  const Eigen::VectorXd edge_on = rate({.water_bodies = {lens}}) - rock;
  EXPECT_LT(facing[0], edge_on[0]) << "early: the rim is nearer";
  EXPECT_GT(facing[2], 5.0 * edge_on[2]) << "late: the currents around the axis are slowest";
  lens.axis_azimuth_deg = 0.0, lens.axis_elevation_deg = 90.0;
  const Eigen::VectorXd lying = rate({.water_bodies = {lens}}) - rock;
  EXPECT_LT((lying - edge_on).norm(), 1e-3 * lying.norm()) << "along the line of sight only the axis' angle counts";
}

TEST(SubsurfaceResponse, RockIsWholeSpaceAndTunnelAndFaultZoneAddTheirTensors) {
  EXPECT_EQ(rate({}), gated_whole_space_response(gates(), 0.003));
  Subsurface tunnel{.rock = {.tunnel_radius_m = 5.0, .tunnel_azimuth_deg = 90.0}, .water_bodies = {}};
  const Eigen::VectorXd across = rate(tunnel) - rate({}), along = rate(tunnel, Eigen::Vector3d::UnitY()) - rate({});
  EXPECT_LT(across[0], 2.0 * along[0]);
  EXPECT_LT(along[0], 0.0);
  const Eigen::VectorXd oblique = rate(tunnel, Eigen::Vector3d(0.6, 0.8, 0.0)) - rate({});
  EXPECT_NEAR(oblique[1], 0.36 * across[1] + 0.64 * along[1], 1e-9 * rate({})[1]);

  Subsurface fault{.rock = {.fault_zone = {.conductance_s = 0.02, .x_m = 9.0}}, .water_bodies = {}};
  const Eigen::VectorXd normal = rate(fault) - rate({}), parallel = rate(fault, Eigen::Vector3d::UnitZ()) - rate({});
  EXPECT_GT(normal[1], 1.5 * parallel[1]);
  EXPECT_GT(parallel[1], 0.0);
  fault.rock.fault_zone.conductance_s = 0.0;
  EXPECT_EQ(rate(fault), rate({}));
}

TEST(SubsurfaceResponse, SamplesConductivitiesLogNormallyAroundTheirMediansBySeed) {
  const Subsurface nominal{.rock = {.conductivity_log_std = 0.3},
                           .water_bodies = {{.conductivity_log_std = 0.2}, {.conductivity_log_std = 0.2}}};
  constexpr int kSeeds = 2000;
  test::Moments rock, body;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Subsurface sampled = sample_subsurface(nominal, seed);
    rock.add(std::log(sampled.rock.conductivity_spm / 0.003));
    body.add(std::log(sampled.water_bodies[1].conductivity_spm / 0.6));
    EXPECT_NE(sampled.water_bodies[0].conductivity_spm, sampled.water_bodies[1].conductivity_spm);
  }
  EXPECT_NEAR(rock.mean(), 0.0, 4.0 * 0.3 / std::sqrt(kSeeds));
  EXPECT_NEAR(rock.std(), 0.3, 4.0 * 0.3 / std::sqrt(2.0 * kSeeds));
  EXPECT_NEAR(body.std(), 0.2, 4.0 * 0.2 / std::sqrt(2.0 * kSeeds));
  const Subsurface fixed = sample_subsurface({.rock = {}, .water_bodies = {{}}}, 7);
  EXPECT_EQ(fixed.rock.conductivity_spm, 0.003);
  EXPECT_EQ(fixed.water_bodies[0].conductivity_spm, 0.6);
}

std::string message(const Subsurface& subsurface) {
  try {
    rate(subsurface);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SubsurfaceResponse, RefusesABodyOrAFaultZoneAtTheCoil) {
  WaterBodySettings near = spheroid(3.0);
  near.x_m = 10.0;
  EXPECT_THAT(message({.rock = {}, .water_bodies = {near}}), HasSubstr("must not contain the antenna"));
  EXPECT_THAT(message({.rock = {.fault_zone = {.conductance_s = 0.02, .x_m = 0.5}}, .water_bodies = {}}),
              HasSubstr("rock.fault_zone: 0.50 m from the antenna: must be at least 1 m"));
}

}  // namespace
}  // namespace patrol::sim::subsurface_response_test
