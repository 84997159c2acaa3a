#include "render/film/director.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patrol::render::director_test {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A minute at the origin, with a fault after 30 s: its shot is from 26 s to 33 s.
Director director_of_a_fault() {
  RunHistory history{.num_states = 2,
                     .begin = 0s,
                     .end = 60s,
                     .T_world_body = {},
                     .errors = {},
                     .approaches = {},
                     .events = {},
                     .collisions = {},
                     .ring_findings = {}};
  for (const Time at : {Time(0s), Time(60s)}) history.T_world_body.push_back({at, {}});
  const ShotSettings settings{.lead_s = 4.0, .lag_s = 3.0};
  ShotPlan plan = plan_shots(history, {{30s, HighlightKind::kFault, "Fault"}}, FilmStyle::kHighlights, {}, settings);
  return Director(std::move(plan), CameraRig(CameraKind::kChase), {});
}

RunSnapshot snapshot_at(Time now) {
  RunSnapshot snapshot;
  snapshot.state.stamp = now;
  return snapshot;
}

TEST(Director, CutsToTheShotAndBack) {
  Director director = director_of_a_fault();
  const View before = director.view(snapshot_at(25900ms), 0.03), during = director.view(snapshot_at(26s), 0.03),
             after = director.view(snapshot_at(33100ms), 0.03);
  EXPECT_LT(before.eye.x(), -1.0) << "from behind";
  EXPECT_GT(during.eye.x(), 0.5) << "from ahead";
  EXPECT_NEAR((after.eye - before.eye).norm(), 0.0, 1e-6) << "the robot has not moved";
}

TEST(Director, SaysWhatIsShownAndHowFast) {
  const Director director = director_of_a_fault();
  EXPECT_THAT(director.note(10s).caption, IsEmpty());
  EXPECT_NEAR(director.note(10s).speed, 8.0, 1e-9);
  const FilmNote note = director.note(30s);
  EXPECT_THAT(note.caption, ElementsAre("Fault"));
  EXPECT_NEAR(note.speed, 2.0, 1e-9);
  ASSERT_EQ(note.marks_s.size(), 1u);
  EXPECT_NEAR(note.film_s - note.marks_s[0], 4.0 / 2.0, 1e-9);  // the lead, slowly
  EXPECT_NEAR(director.note(60s).film_s, note.length_s, 1e-9);
}

}  // namespace
}  // namespace patrol::render::director_test
