#include "inspect/water/sounding_likelihood.h"

#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/soundings.h"

namespace patrol::inspect::sounding_likelihood_test {
namespace {

const ConductiveSphere kBody{.distance_m = 16.0, .radius_m = 6.0, .conductivity_spm = 0.6};
const ConductiveSphere kNone{};
const Eigen::Vector3d kAhead = Eigen::Vector3d(1.0, 0.2, -0.1).normalized();

std::vector<OrientedSounding> soundings(const ConductiveSphere& body, std::uint64_t seed = 1) {
  return test::make_soundings(0.003, body, kAhead, antenna_poses({}, test::antenna_mount()), seed);
}

TEST(SoundingLikelihood, IsLargestNearTheRockThatWasThere) {
  const SoundingLikelihood likelihood({}, soundings(kNone));
  EXPECT_GT(likelihood.log_likelihood_rock(0.003), likelihood.log_likelihood_rock(0.004) + 5.0);
  EXPECT_GT(likelihood.log_likelihood_rock(0.003), likelihood.log_likelihood_rock(0.002) + 5.0);
}

TEST(SoundingLikelihood, OfABodyTooSmallToSeeIsThatOfTheRock) {
  const SoundingLikelihood likelihood({}, soundings(kNone));
  EXPECT_NEAR(
      likelihood.log_likelihood_body(0.003, {.distance_m = 30.0, .radius_m = 0.2, .conductivity_spm = 0.6}, kAhead),
      likelihood.log_likelihood_rock(0.003), 1e-3);
}

TEST(SoundingLikelihood, AheadAndBehindAreAlike) {
  const SoundingLikelihood likelihood({}, soundings(kBody));
  EXPECT_NEAR(likelihood.log_likelihood_body(0.003, kBody, kAhead),
              likelihood.log_likelihood_body(0.003, kBody, -kAhead), 1e-9);
}

// Turning body and antenna together about z changes nothing: steel is alike in all directions, and so is the noise.
TEST(SoundingLikelihood, TurningBodyAndAntennaTogetherChangesNothing) {
  std::vector<OrientedSounding> turned = soundings(kBody);
  constexpr double kTurn_rad = 0.3;
  for (OrientedSounding& aimed : turned) aimed.pose.yaw_rad += kTurn_rad;
  const double before = SoundingLikelihood({}, soundings(kBody)).log_likelihood_body(0.003, kBody, kAhead);
  const double after =
      SoundingLikelihood({}, turned).log_likelihood_body(0.003, kBody, quaternion_from_yaw(kTurn_rad) * kAhead);
  // The prior of steel's share by direction is independent in the six entries of its form, which a turn mixes: hence a
  // little.
  EXPECT_NEAR(after, before, 0.5);
}

TEST(SoundingLikelihood, AGainOfFivePerCentAndASmallShiftOfTimeCostLittleAndTwentyPerCentMuch) {
  const auto scaled = [](double gain) {
    std::vector<OrientedSounding> all = soundings(kBody);
    for (OrientedSounding& aimed : all) {
      for (std::size_t gate = 0; gate < aimed.sounding.rate_tps.size(); ++gate) {
        aimed.sounding.rate_tps[gate] *= gain;
        aimed.sounding.std_tps[gate] *= gain;
      }
    }
    // Deviations of ground and body from the model explain a part of a gain.
    return SoundingLikelihood({.tunnel_air_std = 0.0, .body_shape_std = 0.0}, all)
        .log_likelihood_body(0.003, kBody, kAhead);
  };
  EXPECT_LT(scaled(1.0) - scaled(1.05), 4.0);  // (0.05 / 0.03)^2 / 2 = 1.4, and what time's shift and steel make of it
  EXPECT_GT(scaled(1.0) - scaled(1.3), 8.0);
}

// Peelle's puzzle: were gains sized by the noisy readings, a world in which all signals are smaller would beat the true
// one.
TEST(SoundingLikelihood, TheTruthIsNotBeatenByAWeakerWorld) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const SoundingLikelihood likelihood({}, soundings(kBody, seed));
    const double truth = likelihood.log_likelihood_body(0.003, kBody, kAhead);
    EXPECT_GT(truth + 4.0, likelihood.log_likelihood_body(
                               0.0026, {.distance_m = 17.2, .radius_m = 6.0, .conductivity_spm = 0.6}, kAhead))
        << seed;
  }
}

// Half of the air of an infinite tunnel of 5.5 m radius in rock of 0.003 S/m: -0.035 along and -0.11 across at 2 us.
TEST(SoundingLikelihood, TheAirOfATunnelCostsLessThanTwoOnlyIfItIsModeled) {
  const auto cost = [](double tunnel_air_std) {
    std::vector<OrientedSounding> with_air = soundings(kNone);
    for (OrientedSounding& aimed : with_air) {
      const double cosine = std::cos(aimed.pose.yaw_rad) * std::cos(aimed.pose.pitch_rad);
      for (std::size_t gate = 0; gate < aimed.sounding.rate_tps.size(); ++gate) {
        const double ratio = 2e-6 / aimed.sounding.gate_s[gate];
        aimed.sounding.rate_tps[gate] *=
            1.0 - 0.035 * ratio * cosine * cosine - 0.11 * std::pow(ratio, 0.7) * (1.0 - cosine * cosine);
      }
    }
    const SoundingErrorSettings settings{.tunnel_air_std = tunnel_air_std};
    return SoundingLikelihood(settings, soundings(kNone)).log_likelihood_rock(0.003) -
           SoundingLikelihood(settings, with_air).log_likelihood_rock(0.003);
  };
  EXPECT_LT(cost(0.2), 2.0);
  EXPECT_GT(cost(0.0), 10.0);
}

TEST(SoundingLikelihood, AnOblateBodyIsMoreLikelyWithDeviationsFromASphere) {
  // 1.4 times the moment of the sphere along the line of sight and 0.8 times across it.
  std::vector<OrientedSounding> oblate = soundings(kNone);
  const std::vector<OrientedSounding> sphere = soundings(kBody);
  const Eigen::Vector3d direction = kAhead;
  for (std::size_t i = 0; i < oblate.size(); ++i) {
    const Eigen::Vector3d axis =
        quaternion_from_rpy(0.0, oblate[i].pose.pitch_rad, oblate[i].pose.yaw_rad) * Eigen::Vector3d::UnitX();
    const double cosine_squared = std::pow(axis.dot(direction), 2);
    for (std::size_t gate = 0; gate < oblate[i].sounding.rate_tps.size(); ++gate) {
      double& rate = oblate[i].sounding.rate_tps[gate];
      rate += (sphere[i].sounding.rate_tps[gate] - rate) * (1.4 * cosine_squared + 0.8 * (1.0 - cosine_squared));
    }
  }
  const auto log_likelihood = [&](double body_shape_std) {
    return SoundingLikelihood({.body_shape_std = body_shape_std}, oblate).log_likelihood_body(0.003, kBody, kAhead);
  };
  EXPECT_GT(log_likelihood(0.25), log_likelihood(0.0) + 10.0);
}

TEST(SoundingLikelihood, RefusesNoSoundingsAndGatesThatDiffer) {
  EXPECT_THROW(SoundingLikelihood({}, {}), InputError);
  std::vector<OrientedSounding> odd = soundings(kNone);
  odd[3].sounding.rate_tps.pop_back();
  try {
    SoundingLikelihood({}, odd);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("water sounding at 4.000 s: gates differ"));
  }
  odd = soundings(kNone);
  odd[3].sounding.rate_tps[2] = std::nan("");
  EXPECT_THROW(SoundingLikelihood({}, odd), InputError);
}

}  // namespace
}  // namespace patrol::inspect::sounding_likelihood_test
