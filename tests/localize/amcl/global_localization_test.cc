#include <cstdint>
#include <cstdio>
#include <optional>

#include <gtest/gtest.h>

#include "localize/amcl/monte_carlo.h"
#include "tests/localize/amcl/tunnel_tour.h"
#include "tests/support/tunnel_world.h"

namespace patrol::localize::amcl_global_localization_test {
namespace {

using test::TunnelDrive;

/// Seconds of driving until the pose is right and said to be; none if it was said to be and was not, or never.
std::optional<double> time_to_find(Tour& tour, bool with_ranges, int steps) {
  for (int i = 1; i <= steps; ++i) {
    const LocalizationUpdate update = tour.step(with_ranges);
    if (update.confidence.is_lost) continue;
    if (tour.error_m(update) < 0.15) return i * TunnelDrive::kPeriod_s;
    return std::nullopt;
  }
  return std::nullopt;
}

TEST(Kidnap, OfTwentyMetersIsNoticedAndMendedWithinThirtySecondsByRanges) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Tour tour(seed, {30.0, 0.0, 0.0});
    tour.localizer.set_initial_pose({30.0, 0.0, 0.0}, kNearly);
    tour.look(true);
    for (int i = 0; i < 50; ++i) tour.step(true);
    tour.drive.kidnap_to({tour.drive.T_map_body().x + 20.0, 0.3, 0.02});
    double wrong_s = 0.0;  // not yet noticed, or not yet mended
    double error_m = 20.0;
    for (int i = 1; i <= 100; ++i) {
      const LocalizationUpdate update = tour.step(true);
      error_m = tour.error_m(update);
      if (error_m > 0.15) wrong_s = i * TunnelDrive::kPeriod_s;
    }
    std::printf("kidnap of 20 m, seed %d: found again after %.1f s\n", static_cast<int>(seed), wrong_s);
    EXPECT_LT(wrong_s, 30.0);
    EXPECT_LT(error_m, 0.15);
  }
}

// Carried 20 m along a tunnel that looks alike: the scan cannot tell where to.
TEST(Kidnap, WithoutRangesItReportsLostUntilAFeatureIsInRange) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Tour tour(seed, {35.0, 0.0, 0.0});
    tour.localizer.set_initial_pose({35.0, 0.0, 0.0}, kNearly);
    tour.look(false);
    for (int i = 0; i < 10; ++i) tour.step(false);
    tour.drive.kidnap_to({57.0, 0.5, 0.06});
    double wrong_s = 0.0;
    for (int i = 1; i <= 150; ++i) {
      const LocalizationUpdate update = tour.step(false);
      if (!update.confidence.is_lost && update.confidence.confidence > 0.5 && tour.error_m(update) > 0.5)
        wrong_s += TunnelDrive::kPeriod_s;
    }
    EXPECT_LT(wrong_s, 2.0) << "s of being wrong and sure, seed " << seed;
  }
}

TEST(GlobalLocalization, FromScratchAmongFeaturesTakesOneSecond) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Tour tour(seed, {4.0, 0.5, 0.2});
    const std::optional<double> found_s = time_to_find(tour, false, 10);
    EXPECT_TRUE(found_s) << "seed " << seed;
  }
}

TEST(GlobalLocalization, FromScratchInTheLinedStretchTakesThreeSecondsWithRanges) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Tour tour(seed, {55.0, 0.5, 0.05});
    const std::optional<double> found_s = time_to_find(tour, true, 30);
    EXPECT_TRUE(found_s) << "seed " << seed;
  }
}

// 40 m through the lined stretch, where both directions and every place look alike.
TEST(GlobalLocalization, WithoutRangesInTheLinedStretchItStaysLost) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Tour tour(seed, {45.0, 0.0, 0.0});
    int found = 0;
    for (int i = 0; i < 200; ++i) found += tour.step(false).confidence.is_lost ? 0 : 1;
    EXPECT_EQ(found, 0) << "seed " << seed;
  }
}

}  // namespace
}  // namespace patrol::localize::amcl_global_localization_test
