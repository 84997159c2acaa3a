#include "sim/sensors/tem.h"

#include <cmath>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/moments.h"

namespace patrol::sim::tem_test {
namespace {

using ::testing::HasSubstr;

const RockSettings kRock{.conductivity_spm = 0.003};
const WaterBodySettings kBody{.x_m = 16.0, .y_m = 0.0, .z_m = 1.0};
const Eigen::Vector3d kCoil(0.0, 0.0, 1.0);

/// Nothing but rock and water.
TemSettings ideal() {
  TemSettings settings;
  settings.noise_std_tps = settings.relative_noise_std = settings.gain_std = settings.relative_moment_std =
      settings.time_shift_std_s = settings.steel_response = 0.0;
  return settings;
}

Eigen::Matrix3d along(const Eigen::Vector3d& axis) { return axis * axis.transpose(); }

TemSounding sound(const TemSettings& settings, const std::vector<WaterBodySettings>& bodies,
                  const Eigen::Vector3d& axis, std::uint64_t seed = 1, std::uint64_t count = 0) {
  return Tem(settings, kRock, bodies, seed).sound(kCoil, along(axis), count, Time{});
}

TEST(Tem, InRockAloneAnIdealInstrumentReadsTheMomentTimesTheRocksDecayFromEverySide) {
  const TemSounding ahead = sound(ideal(), {}, Eigen::Vector3d::UnitX()),
                    up = sound(ideal(), {}, Eigen::Vector3d::UnitZ());
  const Eigen::VectorXd rock = gated_whole_space_response(TemGates({.gate_s = ahead.gate_s}), 0.003);
  ASSERT_EQ(ahead.gate_s.size(), 22U);  // ten a decade from 2 to 300 us
  EXPECT_NEAR(ahead.gate_s[10], 2e-5, 1e-12);
  for (std::size_t gate = 0; gate < ahead.gate_s.size(); ++gate) {
    EXPECT_NEAR(ahead.rate_tps[gate], 34.0 * rock[static_cast<Eigen::Index>(gate)], 1e-12 * ahead.rate_tps[gate]);
    EXPECT_EQ(ahead.rate_tps[gate], up.rate_tps[gate]);
  }
}

TEST(Tem, OfABodyAheadItReadsTheAxialDecayAndTurnedBySixtyDegreesAQuarterOfTheWayFromTheTransverse) {
  const TemSounding none = sound(ideal(), {}, Eigen::Vector3d::UnitX()),
                    ahead = sound(ideal(), {kBody}, Eigen::Vector3d::UnitX());
  const TemSounding turned = sound(ideal(), {kBody}, {0.5, std::sqrt(0.75), 0.0});
  const GatedSphereResponse body = gated_sphere_response(TemGates({.gate_s = none.gate_s}), 0.003, {16.0, 6.0, 0.6});
  for (Eigen::Index gate = 0; gate < body.axial.size(); ++gate) {
    const auto g = static_cast<std::size_t>(gate);
    const double tol = 1e-12 * none.rate_tps[g];
    EXPECT_NEAR(ahead.rate_tps[g] - none.rate_tps[g], 34.0 * body.axial[gate], tol);
    EXPECT_NEAR(turned.rate_tps[g] - none.rate_tps[g], 34.0 * (0.25 * body.axial[gate] + 0.75 * body.transverse[gate]),
                tol);
  }
}

TEST(Tem, TwoBodiesAddUp) {
  WaterBodySettings other = kBody;
  other.y_m = 14.0;
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  const double none = sound(ideal(), {}, axis).rate_tps[5], first = sound(ideal(), {kBody}, axis).rate_tps[5];
  const double second = sound(ideal(), {other}, axis).rate_tps[5],
               both = sound(ideal(), {kBody, other}, axis).rate_tps[5];
  EXPECT_NEAR(both - none, first - none + second - none, 1e-12 * none);
}

constexpr int kDraws = 4000;

/// Moments of a gate over many soundings.
test::Moments moments_of(const TemSettings& settings, std::size_t gate) {
  const Tem tem(settings, kRock, {}, 3);
  test::Moments moments;
  for (int count = 0; count < kDraws; ++count) {
    moments.add(
        tem.sound(kCoil, along(Eigen::Vector3d::UnitX()), static_cast<std::uint64_t>(count), Time{}).rate_tps[gate]);
  }
  return moments;
}

// 3 nT/s at 1 ms: at 20 us 3e-9 sqrt(50); four times the stack halves it.
TEST(Tem, NoiseGrowsTowardsEarlyGatesAsTheRootOfTimeAndFallsAsTheRootOfTheStack) {
  TemSettings settings = ideal();
  settings.noise_std_tps = 3e-9;
  const double expected = 3e-9 * std::sqrt(50.0), tol = 4.0 * expected / std::sqrt(2.0 * kDraws);
  EXPECT_NEAR(moments_of(settings, 10).std(), expected, tol);
  settings.stacking_s = 4.0;
  EXPECT_NEAR(moments_of(settings, 10).std(), expected / 2.0, tol / 2.0);
  EXPECT_NEAR(sound(settings, {}, Eigen::Vector3d::UnitX()).std_tps[10], expected / 2.0, 1e-15);
}

TEST(Tem, RelativeNoiseIsOnePerCentOfTheReading) {
  TemSettings settings = ideal();
  settings.relative_noise_std = 0.01;
  const test::Moments moments = moments_of(settings, 0);
  EXPECT_NEAR(moments.std() / moments.mean(), 0.01, 4.0 * 0.01 / std::sqrt(2.0 * kDraws));
}

TEST(Tem, AcrossRunsGainIsTwoPerCentAndTheShiftThirtyNanoseconds) {
  TemSettings settings = ideal();
  settings.gain_std = 0.02, settings.time_shift_std_s = 3e-8;
  const TemSounding clean = sound(ideal(), {}, Eigen::Vector3d::UnitX());
  constexpr int kRuns = 1500;
  test::Moments late, early;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    const TemSounding run = sound(settings, {}, Eigen::Vector3d::UnitX(), seed);
    late.add(run.rate_tps[21] / clean.rate_tps[21]);
    early.add(run.rate_tps[0] / clean.rate_tps[0] - run.rate_tps[21] / clean.rate_tps[21]);
  }
  EXPECT_NEAR(late.std(), 0.02, 4.0 * 0.02 / std::sqrt(2.0 * kRuns));
  // Through the ramp the first gate falls as t^-2.5 on average over 2.0 ... 4.6 us: its slope is (2.0^-2.5 - 4.6^-2.5)
  // / (2.0^-1.5 - 4.6^-1.5) 3/2 = 0.914 a us.
  EXPECT_NEAR(early.std(), 0.914 * 0.03, 0.1 * 0.914 * 0.03);
}

TEST(Tem, SteelDecaysSlowerThanRockAndDiffersByDirectionAndRun) {
  TemSettings settings = ideal();
  settings.steel_response = 5e-9;
  const auto steel = [&](std::size_t gate, const Eigen::Vector3d& axis, std::uint64_t seed) {
    return sound(settings, {}, axis, seed).rate_tps[gate] - sound(ideal(), {}, axis).rate_tps[gate];
  };
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY();
  EXPECT_GT(steel(17, x, 1) / steel(7, x, 1), std::pow(10.0, -2.0));  // over a decade; rock falls by 10^-2.5
  EXPECT_GT(std::abs(steel(7, x, 1) / steel(7, y, 1) - 1.0), 0.01);
  EXPECT_GT(std::abs(steel(7, x, 1) / steel(7, x, 2) - 1.0), 0.01);
  EXPECT_NEAR(steel(17, x, 1) / steel(7, x, 1), steel(17, y, 1) / steel(7, y, 1), 1e-9);
}

TEST(Tem, ASoundingTakesASecondAndIsOfTheMeanOfTheCoilsAxes) {
  Tem tem(ideal(), kRock, {kBody}, 1);
  EXPECT_FALSE(tem.step({kCoil, Eigen::Quaterniond::Identity()}, Time{}));
  tem.start(Time{});
  EXPECT_TRUE(tem.is_sounding());
  const Pose3 ahead{kCoil, Eigen::Quaterniond::Identity()}, left{kCoil, quaternion_from_yaw(M_PI / 2.0)};
  std::optional<TemSounding> sounding;
  int tick = 0;
  while (!sounding && tick < 2000) {
    ++tick;
    sounding = tem.step(tick % 2 == 0 ? ahead : left, from_seconds(0.002 * tick));
  }
  ASSERT_TRUE(sounding);
  EXPECT_EQ(sounding->stamp, from_seconds(1.0));
  EXPECT_FALSE(tem.is_sounding());
  const double x = sound(ideal(), {kBody}, Eigen::Vector3d::UnitX()).rate_tps[5],
               y = sound(ideal(), {kBody}, Eigen::Vector3d::UnitY()).rate_tps[5];
  EXPECT_NEAR(sounding->rate_tps[5], 0.5 * (x + y), 1e-9 * x);
}

TEST(Tem, SameSeedAndCountSameSounding) {
  const TemSounding first = sound({}, {kBody}, Eigen::Vector3d::UnitX(), 5, 7),
                    again = sound({}, {kBody}, Eigen::Vector3d::UnitX(), 5, 7);
  EXPECT_EQ(first.rate_tps, again.rate_tps);
  EXPECT_NE(first.rate_tps, sound({}, {kBody}, Eigen::Vector3d::UnitX(), 5, 8).rate_tps);
}

std::string complaint(const TemSettings& settings, const WaterBodySettings& body) {
  try {
    sound(settings, {body}, Eigen::Vector3d::UnitX());
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Tem, TheGateAtTheUpperLimitIsNotLostByRounding) {
  for (const double per_decade : {3.0, 5.0, 10.0, 20.0, 30.0}) {
    for (const auto& [first_s, last_s, decades] :
         {std::tuple(1e-6, 1e-3, 3.0), std::tuple(2e-6, 2e-4, 2.0), std::tuple(1e-5, 1e-4, 1.0)}) {
      TemSettings settings = ideal();
      settings.first_gate_s = first_s;
      settings.last_gate_s = last_s;
      settings.gates_per_decade = per_decade;
      const std::vector<double> gate_s = sound(settings, {}, Eigen::Vector3d::UnitX()).gate_s;
      EXPECT_EQ(gate_s.size(), static_cast<std::size_t>(decades * per_decade) + 1) << per_decade << " from " << first_s;
      EXPECT_NEAR(gate_s.back() / last_s, 1.0, 1e-9);
    }
  }
}

TEST(Tem, RefusesABodyAboutTheAntennaAndGatesThatAreNone) {
  WaterBodySettings near = kBody;
  near.x_m = 6.0;
  EXPECT_THAT(complaint({}, near), HasSubstr("must not contain the antenna"));
  TemSettings settings;
  settings.last_gate_s = 2.2e-6;
  EXPECT_THAT(complaint(settings, kBody), HasSubstr("sensors.tem.last_gate_s = 2.2e-06"));
  settings = {};
  settings.relative_gate_width = 0.9;
  EXPECT_THAT(complaint(settings, kBody), HasSubstr("sensors.tem.relative_gate_width = 0.9"));
}

}  // namespace
}  // namespace patrol::sim::tem_test
