#include "render/film/speed_plan.h"

#include <gtest/gtest.h>

namespace patrol::render::speed_plan_test {
namespace {

using namespace std::chrono_literals;

constexpr double kAlgebraTol = 1e-9;
constexpr SpeedSettings kSpeeds{
    .fast = 8.0, .slow = 2.0, .ramp_s = 1.25};  // ramps of 2 * 1.25 / (1/8 + 1/2) = 4 s of the run

TEST(SpeedPlan, WithoutSlowSpansIsEven) {
  const SpeedPlan plan({0s, 80s}, {}, kSpeeds);
  EXPECT_NEAR(plan.length_s(), 10.0, kAlgebraTol);
  EXPECT_EQ(plan.run_time(2.5), Time(20s));
  EXPECT_NEAR(plan.film_s(40s), 5.0, kAlgebraTol);
  EXPECT_NEAR(plan.speed(40s), 8.0, kAlgebraTol);
}

// 100 / 8 + ((8 + 4) + (6 + 4)) (1/2 - 1/8) = 12.5 + 8.25 s
TEST(SpeedPlan, IsAsLongAsTheClosedFormSays) {
  const SpeedPlan plan({0s, 100s}, {{20s, 28s}, {60s, 66s}}, kSpeeds);
  EXPECT_NEAR(plan.length_s(), 20.75, kAlgebraTol);
}

// Over a whole ramp the pace is 5/16 in the mean: 4 s of the run are 1.25 s of film. Before it 16 s are 2 s.
TEST(SpeedPlan, GoesOverToSlowAlongARamp) {
  const SpeedPlan plan({0s, 100s}, {{20s, 28s}}, kSpeeds);
  EXPECT_NEAR(plan.film_s(16s), 2.0, kAlgebraTol);
  EXPECT_NEAR(plan.film_s(20s), 3.25, kAlgebraTol);
  EXPECT_NEAR(plan.film_s(28s), 3.25 + 8.0 / 2.0, kAlgebraTol);
  EXPECT_NEAR(plan.speed(18s), 16.0 / 5.0, kAlgebraTol);
  EXPECT_NEAR(plan.speed(24s), 2.0, kAlgebraTol);
}

TEST(SpeedPlan, RunsForwardsAndItsTwoMapsAreInverse) {
  const SpeedPlan plan({0s, 100s}, {{2s, 9s}, {14s, 20s}, {60s, 66s}, {97s, 120s}}, kSpeeds);
  Time last = Time::min();
  for (double film_s = 0.0; film_s <= plan.length_s(); film_s += 0.01) {
    const Time now = plan.run_time(film_s);
    EXPECT_GT(now, last);
    EXPECT_NEAR(plan.film_s(now), film_s, 1e-8);  // the run's time is a number of nanoseconds
    last = now;
  }
  EXPECT_NEAR(to_seconds(plan.run_time(plan.length_s())), 100.0, 1e-8);
}

// The first begins 2 s into the run, its ramp would begin 2 s before that: half of it is left, 2 s at 1/2 - 3/16 / 2 in
// the mean. The last is cut to 98 ... 100 s. 100/8 + 3/8 (5 + 4) - 3/8 * 0.5 [the missing part of the first ramp] + 3/8
// (2 + 2)
TEST(SpeedPlan, CutsOffWhatIsBeyondTheRun) {
  const SpeedPlan plan({0s, 100s}, {{2s, 7s}, {98s, 104s}}, kSpeeds);
  EXPECT_NEAR(plan.length_s(), 12.5 + 0.375 * (5.0 + 4.0) - 0.375 * 0.5 + 0.375 * (2.0 + 2.0), kAlgebraTol);
}

TEST(SpeedPlan, SpansWhoseRampsMeetAreOne) {
  const SpeedPlan apart({0s, 100s}, {{20s, 24s}, {30s, 34s}}, kSpeeds), joined({0s, 100s}, {{20s, 34s}}, kSpeeds);
  EXPECT_NEAR(apart.length_s(), joined.length_s(), kAlgebraTol);
}

TEST(SpeedPlan, NothingIsFasterThanFastForBeingSlow) {
  const SpeedPlan plan({0s, 100s}, {{20s, 24s}}, {.fast = 1.0, .slow = 2.0});
  EXPECT_NEAR(plan.length_s(), 100.0, kAlgebraTol);
}

TEST(SpeedPlan, OfARunOfOneInstantShowsThatInstant) {
  const SpeedPlan plan({3s, 3s}, {}, kSpeeds);
  EXPECT_EQ(plan.length_s(), 0.0);
  EXPECT_EQ(plan.run_time(0.0), Time(3s));
}

}  // namespace
}  // namespace patrol::render::speed_plan_test
