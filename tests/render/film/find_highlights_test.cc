#include "render/film/find_highlights.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patrol::render::find_moments_test {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A minute of standing at the origin, without errors.
RunHistory quiet_minute() {
  RunHistory history{.num_states = 601,
                     .begin = 0s,
                     .end = 60s,
                     .T_world_body = {},
                     .errors = {},
                     .approaches = {},
                     .events = {},
                     .collisions = {},
                     .ring_findings = {}};
  for (Time now = 0s; now <= 60s; now += 100ms) {
    history.T_world_body.push_back({now, {}});
    history.errors.push_back({now, Eigen::Vector2d::Zero()});
  }
  return history;
}

std::vector<Time> instants(const std::vector<Highlight>& highlights, HighlightKind kind) {
  std::vector<Time> at;
  for (const Highlight& highlight : highlights) {
    if (highlight.kind == kind) at.push_back(highlight.at);
  }
  return at;
}

std::vector<Highlight> moments_of(const RunHistory& history, std::vector<Highlight> announced = {}) {
  return find_highlights(history, {}, std::move(announced));
}

TEST(FindMoments, AQuietRunHasNone) { EXPECT_THAT(moments_of(quiet_minute()), IsEmpty()); }

TEST(FindMoments, TheLargestErrorIsOne) {
  RunHistory history = quiet_minute();
  history.errors[120].error_in_world_m = {0.0, 0.05};
  history.errors[300].error_in_world_m = {0.06, 0.08};
  const std::vector<Highlight> highlights = moments_of(history);
  ASSERT_THAT(instants(highlights, HighlightKind::kMaxError), ElementsAre(30s));
  EXPECT_EQ(highlights[0].title, "Maximum position error: 0.100 m");
}

TEST(FindMoments, ALiningAlarmIsOneAndLooksAtTheRing) {
  RunHistory history = quiet_minute();
  history.events.push_back({.stamp = 20s,
                            .kind = EventKind::kLiningAlarm,
                            .subject = "ring_31",
                            .text = "Ring 31 has moved inward by 12.0 mm.",
                            .T_map_body = {},
                            .p_map_target = {3.0, 4.0}});
  history.ring_findings = {{.ring = 30, .p_map = {3.5, 4.0, 1.0}}, {.ring = 31, .p_map = {3.0, 4.0, 5.5}}};
  const std::vector<Highlight> highlights = moments_of(history);
  ASSERT_THAT(instants(highlights, HighlightKind::kAlarm), ElementsAre(20s));
  EXPECT_EQ(highlights[0].subject_height_m, 5.5);
  EXPECT_EQ(highlights[0].title, "Ring 31 has moved inward by 12.0 mm");
  EXPECT_EQ(highlights[0].p_world_subject, Eigen::Vector2d(3.0, 4.0));
}

TEST(FindMoments, AnErrorThatNobodyWouldSeeIsNone) {
  RunHistory history = quiet_minute();
  history.errors[120].error_in_world_m = {0.02, 0.0};
  EXPECT_THAT(moments_of(history), IsEmpty());
}

TEST(FindMoments, OfEachEncounterTheNearestInstantCounts) {
  RunHistory history = quiet_minute();
  const auto meet = [&](Time at, const char* actor, double clearance_m) {
    history.approaches.push_back({at, actor, clearance_m, {1.0, 2.0}});
  };
  for (int i = -5; i <= 5; ++i) meet(20s + i * 200ms, "pedestrian_1", 0.4 + 0.05 * std::abs(i));
  meet(40s, "car_1", 0.7);
  meet(50s, "car_1", 1.2);  // not near
  const std::vector<Highlight> highlights = moments_of(history);
  ASSERT_THAT(instants(highlights, HighlightKind::kNearMiss), ElementsAre(20s, 40s));
  EXPECT_EQ(highlights[0].title, "0.40 m from pedestrian 1");
  EXPECT_EQ(*highlights[0].p_world_subject, Eigen::Vector2d(1.0, 2.0));
}

TEST(FindMoments, OnlyTheNearestEncountersAreShown) {
  RunHistory history = quiet_minute();
  for (int i = 1; i <= 5; ++i) history.approaches.push_back({i * 10s, "pedestrian_1", 0.9 - 0.1 * i, {}});
  EXPECT_THAT(instants(moments_of(history), HighlightKind::kNearMiss), ElementsAre(30s, 40s, 50s));
}

TEST(FindMoments, TouchesWithinSecondsAreOneCollision) {
  RunHistory history = quiet_minute();
  for (const Time at : {Time(10s), Time(11s), Time(13s), Time(30s)})
    history.collisions.push_back({at, "trunk", "barrier_3"});
  const std::vector<Highlight> highlights = moments_of(history);
  ASSERT_THAT(instants(highlights, HighlightKind::kCollision), ElementsAre(10s, 30s));
  EXPECT_EQ(highlights[0].title, "Collision with barrier 3");
}

TEST(FindMoments, ALeapOfTheTruthIsAKidnapAndNotACorrection) {
  RunHistory history = quiet_minute();
  for (std::size_t i = 250; i < history.T_world_body.size(); ++i) {
    history.T_world_body[i].pose.position.x() = 22.0;
    history.errors[i].error_in_world_m = {i < 290 ? -22.0 : 0.0, 0.0};
  }
  const std::vector<Highlight> highlights = moments_of(history);
  ASSERT_THAT(instants(highlights, HighlightKind::kKidnap), ElementsAre(25s));
  ASSERT_THAT(instants(highlights, HighlightKind::kCorrection), ElementsAre(29s)) << "the robot finds back";
  EXPECT_EQ(highlights.back().title, "Estimate corrected by 22.00 m");
}

TEST(FindMoments, EventsComeWithTheirOwnWords) {
  RunHistory history = quiet_minute();
  const auto say = [&](Time at, EventKind kind, const char* subject, const char* text, double value) {
    history.events.push_back({.stamp = at,
                              .kind = kind,
                              .subject = subject,
                              .text = text,
                              .value = value,
                              .T_map_body = {},
                              .p_map_target = {3.0, 1.0}});
  };
  say(10s, EventKind::kGoalReached, "goal_1", "At goal_1.", 1.0);
  say(20s, EventKind::kGasAlarm, "box_2", "Leak at box_2: 4070 ppm m.", 4070.2);
  say(25s, EventKind::kReplan, "", "Something stands on the path.", 0.0);
  say(30s, EventKind::kDocked, "", "Docked at the charging post.", 1.0);
  say(40s, EventKind::kLocalizationLost, "", "The robot does not know where it is.", 0.0);
  const std::vector<Highlight> highlights = find_highlights(history, {10.0, 0.0, 0.0});
  std::vector<std::string> titles;
  for (const Highlight& highlight : highlights) titles.push_back(highlight.title);
  EXPECT_THAT(titles, ElementsAre("At goal 1", "Leak at box 2: 4070 ppm m of methane", "Docked at the charging post",
                                  "Localization lost"));
  EXPECT_EQ(*highlights[1].p_world_subject, Eigen::Vector2d(13.0, 1.0)) << "a place in the map, brought to world";
}

TEST(FindMoments, WhatIsAnnouncedTakesItsPlaceInTime) {
  RunHistory history = quiet_minute();
  history.collisions.push_back({10s, "trunk", "wall"});
  const std::vector<Highlight> highlights =
      moments_of(history, {{20s, HighlightKind::kFault, "Fault: dropout of lidar"},
                           {5s, HighlightKind::kFault, "early"},
                           {99s, HighlightKind::kFault, "after the end"}});
  ASSERT_EQ(highlights.size(), 3u);
  EXPECT_EQ(highlights[0].title, "early");
  EXPECT_EQ(highlights[1].kind, HighlightKind::kCollision);
  EXPECT_EQ(highlights[2].at, Time(20s));
}

}  // namespace
}  // namespace patrol::render::find_moments_test
