#include "render/film/shot_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace patrol::render::shot_plan_test {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

const SpeedSettings kSpeeds{};
const ShotSettings kHighlights{.lead_s = 5.0, .lag_s = 4.0, .same_scene_s = 4.0, .max_shots = 3};

/// Two minutes along x at 1 m/s.
RunHistory two_minutes() {
  RunHistory history{.num_states = 2,
                     .begin = 0s,
                     .end = 120s,
                     .T_world_body = {},
                     .errors = {},
                     .approaches = {},
                     .events = {},
                     .collisions = {},
                     .ring_findings = {}};
  for (const Time at : {Time(0s), Time(120s)})
    history.T_world_body.push_back({at, {{to_seconds(at), 0.0, 0.3}, Eigen::Quaterniond::Identity()}});
  return history;
}

ShotPlan plan(const std::vector<Highlight>& highlights, FilmStyle style = FilmStyle::kHighlights) {
  return plan_shots(two_minutes(), highlights, style, kSpeeds, kHighlights);
}

TEST(ShotPlan, ASceneBeginsBeforeItsMomentAndEndsAfterIt) {
  const ShotPlan one = plan({{60s, HighlightKind::kAlarm, "Leak", Eigen::Vector2d(61.0, 2.0)}});
  ASSERT_EQ(one.shots.size(), 1u);
  EXPECT_EQ(one.shots[0].span.from, Time(55s));
  EXPECT_EQ(one.shots[0].span.to, Time(64s));
  EXPECT_EQ(one.shots[0].kind, ShotKind::kTwoSubjects);
  EXPECT_NEAR(one.shots[0].T_world_body.position.x(), 60.0, 1e-9);
  EXPECT_NEAR(one.speed.speed(60s), 2.0, 1e-9);
  EXPECT_NEAR(one.speed.speed(20s), 8.0, 1e-9);
}

TEST(ShotPlan, MomentsCloseToEachOtherAreOneSceneToldInOrder) {
  const ShotPlan one = plan({{60s, HighlightKind::kKidnap, "Lifted"},
                             {61s, HighlightKind::kLost, "Lost"},
                             {64s, HighlightKind::kRelocalized, "Found"}});
  ASSERT_EQ(one.shots.size(), 1u);
  EXPECT_THAT(one.shots[0].caption, ElementsAre("Lifted", "Lost", "Found"));
  EXPECT_EQ(one.shots[0].kind, ShotKind::kOverhead);
  EXPECT_EQ(one.shots[0].span.to, Time(68s));
}

TEST(ShotPlan, OfTooManyMomentsInOneSceneTheLeastNotableIsNotTold) {
  const ShotPlan one = plan({{60s, HighlightKind::kMaxError, "Error"},
                             {60s, HighlightKind::kKidnap, "Lifted"},
                             {61s, HighlightKind::kLost, "Lost"},
                             {62s, HighlightKind::kRelocalized, "Found"}});
  EXPECT_THAT(one.shots[0].caption, ElementsAre("Lifted", "Lost", "Found"));
}

TEST(ShotPlan, ScenesThatWouldOverlapMeetInTheMiddle) {
  const ShotPlan two = plan({{60s, HighlightKind::kNearMiss, "Near"}, {66s, HighlightKind::kDocking, "Docked"}});
  ASSERT_EQ(two.shots.size(), 2u);
  EXPECT_EQ(two.shots[0].span.to, Time(62500ms));  // of 61 s and 64 s
  EXPECT_EQ(two.shots[1].span.from, Time(62500ms));
}

TEST(ShotPlan, TheLessNotableScenesAreChaptersOnly) {
  std::vector<Highlight> highlights;
  for (int i = 1; i <= 5; ++i)
    highlights.push_back(
        {i * 20s, i % 2 == 0 ? HighlightKind::kCollision : HighlightKind::kGoal, "moment " + std::to_string(i)});
  const ShotPlan some = plan(highlights);
  ASSERT_EQ(some.shots.size(), 3u);  // both collisions, and the first of the goals
  EXPECT_EQ(some.shots[0].caption[0], "moment 1");
  EXPECT_EQ(some.shots[1].caption[0], "moment 2");
  EXPECT_EQ(some.shots[2].caption[0], "moment 4");
  EXPECT_EQ(some.chapters.size(), 6u);
}

TEST(ShotPlan, ChaptersFollowEachOtherFromTheBeginToTheEndOfTheFilm) {
  const ShotPlan some = plan({{1s, HighlightKind::kMission, "Mission begins"},
                              {60s, HighlightKind::kGoal, "Goal"},
                              {100s, HighlightKind::kAlarm, "Leak"}});
  ASSERT_EQ(some.chapters.size(), 3u);
  EXPECT_EQ(some.chapters[0].title, "Mission begins") << "nothing comes before it";
  EXPECT_EQ(some.chapters[0].begin_s, 0.0);
  for (std::size_t i = 1; i < some.chapters.size(); ++i)
    EXPECT_EQ(some.chapters[i].begin_s, some.chapters[i - 1].end_s);
  EXPECT_NEAR(some.chapters[1].begin_s, some.speed.film_s(55s), 1e-9);
  EXPECT_NEAR(some.chapters.back().end_s, some.speed.length_s(), 1e-9);
}

TEST(ShotPlan, APlainCutIsEvenAndHasChaptersAllTheSame) {
  const ShotPlan even = plan({{60s, HighlightKind::kAlarm, "Leak"}}, FilmStyle::kContinuous);
  EXPECT_THAT(even.shots, IsEmpty());
  EXPECT_NEAR(even.speed.length_s(), 120.0 / 8.0, 1e-9);
  EXPECT_EQ(even.chapters.size(), 2u);
}

TEST(ShotPlan, KnowsTheNamesOfItsCuts) {
  EXPECT_EQ(parse_film_style("continuous"), FilmStyle::kContinuous);
  try {
    parse_film_style("fast");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "fast: must be one of highlights, continuous");
  }
}

}  // namespace
}  // namespace patrol::render::shot_plan_test
