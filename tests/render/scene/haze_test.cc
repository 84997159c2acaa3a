#include "render/scene/haze.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "sim/dust.h"

namespace patrol::render::haze_test {
namespace {

constexpr int kSize = 101;  // odd: the middle pixel lies on the axis
constexpr int kMiddle = kSize / 2;
constexpr Color kThing{200, 20, 40}, kAir{80, 70, 60};
constexpr double kRounding = 0.51;

/// Straight ahead, an eighth of a turn to each edge.
View right_angled() {
  View view = look_at({0.0, 0.0, 0.0}, {1.0, 0.0, 0.0});
  view.field_of_view_rad = 0.5 * std::numbers::pi;
  return view;
}

/// A wall across the axis, everywhere of one colour, seen through the haze.
Frame wall_in_haze(double distance_m, double extinction_per_m, const View& view = right_angled()) {
  const double depth = view.far_m / (view.far_m - view.near_m) * (1.0 - view.near_m / distance_m);
  Frame frame(kSize, kSize, kThing);
  add_haze(frame, std::vector<float>(kSize * kSize, static_cast<float>(depth)), view, {extinction_per_m, kAir});
  return frame;
}

double left_of_contrast(const Color& seen) { return (seen.r - kAir.r) / static_cast<double>(kThing.r - kAir.r); }

TEST(Haze, InClearAirNoPixelChanges) { EXPECT_EQ(wall_in_haze(30.0, 0.0), Frame(kSize, kSize, kThing)); }

// visibility = ln 50 / extinction, so at half of it sqrt(1 / 50) = 0.141 is left.
TEST(Haze, AtHalfTheVisibilityFourteenPercentOfTheContrastIsLeft) {
  const sim::DustSettings dust{.enabled = true, .visibility_m = 20.0};
  View view = right_angled();
  view.near_m = 1e-3;
  const Color seen = wall_in_haze(10.0, dust.extinction_per_m(), view).at(kMiddle, kMiddle);
  EXPECT_NEAR(left_of_contrast(seen), 0.1414, kRounding / (kThing.r - kAir.r));
  EXPECT_NEAR(seen.g, 70.0 - 0.1414 * 50.0, kRounding);
  EXPECT_NEAR(seen.b, 60.0 - 0.1414 * 20.0, kRounding);
}

TEST(Haze, AHundredthOfTheVisibilityAwayNearlyAllIsSeen) {
  EXPECT_GT(left_of_contrast(wall_in_haze(0.25, std::log(50.0) / 20.0).at(kMiddle, kMiddle)), 0.95);
}

// The middle of the edge is seen under 44.7 degrees: tan = 50 / 50.5, the way is sqrt(1 + (50 / 50.5)^2) = 1.407 times
// as long.
TEST(Haze, CountsTheWayAlongTheRayAndNotAlongTheAxis) {
  const Frame frame = wall_in_haze(10.0, 0.1);
  const double way_m = 10.0 - right_angled().near_m;
  EXPECT_NEAR(left_of_contrast(frame.at(kMiddle, kMiddle)), std::exp(-0.1 * way_m), kRounding / 120.0);
  EXPECT_NEAR(left_of_contrast(frame.at(0, kMiddle)), std::exp(-0.1 * 1.407 * way_m), kRounding / 120.0);
}

TEST(Haze, TheAirBeforeTheNearPlaneIsCutAwayToo) {
  View view = right_angled();
  view.near_m = 8.0;
  EXPECT_NEAR(left_of_contrast(wall_in_haze(10.0, 0.1, view).at(kMiddle, kMiddle)), std::exp(-0.1 * 2.0),
              kRounding / 120.0);
}

}  // namespace
}  // namespace patrol::render::haze_test
