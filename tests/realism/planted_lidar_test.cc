#include "realism/planted_lidar.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patrol::realism {
namespace {

using ::testing::HasSubstr;

std::size_t num_held(const PlantedTrial& trial) {
  std::size_t held = 0;
  for (const auto& [name, value] : trial.values) held += trial.fit.of(name).contains(value) ? 1 : 0;
  return held;
}

std::string text_of(const PlantedTrial& trial) {
  std::string text;
  for (const auto& [name, value] : trial.values) {
    const FittedParameter& p = trial.fit.of(name);
    text += name + ": planted " + std::to_string(value) + ", fitted " + std::to_string(p.value) + " [" +
            std::to_string(p.low) + ", " + std::to_string(p.high) + "] " + p.reason + "\n";
  }
  return text;
}

// 40 trials of full size: patrol study lidar-calibration.
TEST(PlantedLidar, ThirteenOfFourteenIntervalsHoldInATrialOf30Scans) {
  const Site site = planted_site(false);
  const PlantedTrial trial = run_planted_trial(site, {.scans = 30}, 2001);
  ASSERT_EQ(trial.values.size(), 14u);
  EXPECT_GE(num_held(trial), 13u) << text_of(trial);
  for (const char* name : {"range_noise_std_m", "range_quantization_m", "dropout_probability", "max_incidence_deg",
                           "max_range_10pct_m", "beam_width_deg", "measured_range_offset_m"}) {
    EXPECT_TRUE(trial.fit.of(name).is_seen) << name;
  }
  const double noise_m = trial.planted.settings.range_noise_std_m;
  EXPECT_NEAR(trial.fit.of("range_noise_std_m").value, noise_m, 0.1 * noise_m);
}

TEST(PlantedLidar, APlainRoomDoesNotConstrainTheBeamWidth) {
  const PlantedTrial trial = run_planted_trial(planted_site(true), {.scans = 12, .is_plain_room = true}, 2002);
  const FittedParameter& width = trial.fit.of("beam_width_deg");
  EXPECT_FALSE(width.is_seen);
  EXPECT_THAT(width.reason, HasSubstr("beams after jumps"));
  EXPECT_FALSE(trial.fit.of("max_incidence_deg").is_seen);
  EXPECT_FALSE(trial.fit.of("angle_noise_std_deg").is_seen);
  EXPECT_GE(num_held(trial), 12u) << text_of(trial);  // three misses of fourteen have a probability of 3 %
  // The device of the fit keeps the base's value of a parameter that is not observable.
  LidarDevice base;
  base.settings.beam_width_deg = 0.33;
  EXPECT_EQ(trial.fit.device(base).settings.beam_width_deg, 0.33);
}

}  // namespace
}  // namespace patrol::realism
