#include "slam/consistency/map_consistency.h"

#include <gtest/gtest.h>

#include "tests/slam/graph/office_world.h"

namespace patrol::slam::map_consistency_test {
namespace {

/// Two laps of the office, 0.3 m from scan to scan, in true poses from the first.
struct Drive {
  ConsistencyCheck check;
  std::vector<Pose2> T_map_body;
};

/// `match_score` [scan]: fraction of matched points, for scans from `unmatched_from` to `unmatched_to` zero.
Drive two_laps(std::size_t unmatched_from = 0, std::size_t unmatched_to = 0) {
  const test::RoomWorld office = test::make_office();
  const RandomStream noise(1, "test/consistency");
  Drive drive;
  for (const test::DriveStep& step : test::drive_along(test::office_rounds(2), {.speed_mps = 1.5})) {
    const std::size_t k = drive.T_map_body.size();
    drive.T_map_body.push_back(step.T_world_body);
    drive.check.add(
        office.scan(step.T_world_body, step.stamp, test::kOldLidar, noise, k),
        {.T_map_body = step.T_world_body, .match_score = k >= unmatched_from && k < unmatched_to ? 0.0 : 0.9});
  }
  return drive;
}

TEST(MapConsistency, OfTwoLapsInTheirTruePosesIsComplete) {
  const Drive drive = two_laps();
  const MapConsistency result = drive.check.check(drive.T_map_body);
  EXPECT_TRUE(result.is_consistent());
  EXPECT_TRUE(result.disagreements.empty());
  EXPECT_GT(result.num_compared, 2 * result.num_segments);
  EXPECT_EQ(result.num_unmatched, 0U);
}

TEST(MapConsistency, ASecondLap60CentimetersAsideDisagreesBy60Centimeters) {
  Drive drive = two_laps();
  const std::size_t half = drive.T_map_body.size() / 2;
  for (std::size_t k = half; k < drive.T_map_body.size(); ++k) {
    drive.T_map_body[k].x += 0.36;
    drive.T_map_body[k].y += 0.48;
  }
  const MapConsistency result = drive.check.check(drive.T_map_body);
  EXPECT_FALSE(result.is_consistent());
  ASSERT_GE(result.disagreements.size(), 10U);
  int about_60_cm = 0, between_laps = 0;
  for (const Disagreement& entry : result.disagreements) {
    about_60_cm += std::abs(entry.offset_m - 0.6) < 0.15 ? 1 : 0;
    between_laps += entry.first_scan < half + 20 && entry.second_scan + 20 >= half ? 1 : 0;
  }
  const int num = static_cast<int>(result.disagreements.size());
  EXPECT_GE(4 * about_60_cm, 3 * num);
  EXPECT_EQ(between_laps, num);
}

// Below the distance at which a surface counts as the same.
TEST(MapConsistency, ASecondLapTenCentimetersAsideDoesNotDisagree) {
  Drive drive = two_laps();
  for (std::size_t k = drive.T_map_body.size() / 2; k < drive.T_map_body.size(); ++k) drive.T_map_body[k].x += 0.1;
  EXPECT_TRUE(drive.check.check(drive.T_map_body).is_consistent());
}

// One lap as a session after another lap; only its own segments count.
TEST(MapConsistency, ASessionThatIs60CentimetersAsideDisagreesWithEarlierSessions) {
  const test::RoomWorld office = test::make_office();
  const RandomStream noise(2, "test/consistency");
  std::vector<Keyframe> earlier;
  ConsistencyCheck check;
  std::vector<Pose2> right, aside;
  for (const test::DriveStep& step : test::drive_along(test::office_rounds(1), {.speed_mps = 1.5})) {
    const std::size_t k = right.size();
    earlier.push_back(
        {ScanGroup(office.scan(step.T_world_body, step.stamp, test::kOldLidar, noise, 2 * k)), step.T_world_body});
    check.add(office.scan(step.T_world_body, step.stamp, test::kOldLidar, noise, 2 * k + 1),
              {.T_map_body = step.T_world_body, .match_score = 0.9});
    right.push_back(step.T_world_body);
    aside.push_back(Pose2{0.36, 0.48, 0.0} * step.T_world_body);
  }
  const MapConsistency alone = check.check(aside), consistent = check.check(right, earlier),
                       inconsistent = check.check(aside, earlier);
  EXPECT_TRUE(alone.disagreements.empty());
  EXPECT_TRUE(consistent.is_consistent());
  EXPECT_GT(consistent.num_compared, alone.num_compared);
  EXPECT_EQ(consistent.num_segments, alone.num_segments);
  EXPECT_FALSE(inconsistent.is_consistent());
  ASSERT_FALSE(inconsistent.disagreements.empty());
  for (const Disagreement& entry : inconsistent.disagreements) EXPECT_FALSE(entry.first_scan);
  EXPECT_NEAR(inconsistent.disagreements[inconsistent.disagreements.size() / 2].offset_m, 0.6, 0.15);
}

TEST(MapConsistency, UnmatchedScansAreCountedAndAQuarterOfThemIsTooMany) {
  const Drive few = two_laps(10, 40);
  const MapConsistency result = few.check.check(few.T_map_body);
  EXPECT_TRUE(result.is_consistent());
  EXPECT_EQ(result.num_unmatched, 30U);
  ASSERT_EQ(result.unmatched_segments.size(), 1U);
  EXPECT_EQ(result.unmatched_segments[0].first_scan, 10U);
  EXPECT_EQ(result.unmatched_segments[0].num_scans, 30U);
  EXPECT_EQ(result.unmatched_segments[0].p_map, few.T_map_body[10].position());

  const Drive many = two_laps(10, 10 + few.T_map_body.size() / 4);
  EXPECT_FALSE(many.check.check(many.T_map_body).is_consistent());
}

/// A lap of the office without the scans of 12 m of it.
Drive lap_with_a_gap(double laps) {
  const test::RoomWorld office = test::make_office();
  const RandomStream noise(1, "test/consistency");
  const std::vector<test::DriveStep> steps = test::drive_along(test::office_rounds(2), {.speed_mps = 1.5});
  const auto num_steps = static_cast<std::size_t>(0.5 * laps * static_cast<double>(steps.size()));
  Drive drive;
  for (std::size_t k = 0; k < num_steps; ++k) {
    if (k >= 60 && k < 100) continue;
    drive.T_map_body.push_back(steps[k].T_world_body);
    drive.check.add(office.scan(steps[k].T_world_body, steps[k].stamp, test::kOldLidar, noise, k),
                    {.T_map_body = steps[k].T_world_body, .match_score = 0.9});
  }
  return drive;
}

TEST(MapConsistency, AfterAGapOf12MetersIsUnconnectedUntilASecondLapSeesBothSidesOfIt) {
  const Drive once = lap_with_a_gap(0.8), twice = lap_with_a_gap(2.0);
  const MapConsistency apart = once.check.check(once.T_map_body), whole = twice.check.check(twice.T_map_body);
  EXPECT_TRUE(apart.disagreements.empty());
  EXPECT_FALSE(apart.is_consistent());
  ASSERT_EQ(apart.unconnected.size(), 1U);
  EXPECT_EQ(apart.unconnected[0].first_scan, 60U);
  EXPECT_EQ(apart.unconnected[0].p_map, once.T_map_body[60].position());
  EXPECT_NEAR(apart.unconnected[0].distance_m, (once.T_map_body[60].position() - once.T_map_body[59].position()).norm(),
              1e-12);
  EXPECT_TRUE(whole.unconnected.empty());
  EXPECT_TRUE(whole.is_consistent());
}

TEST(MapConsistency, ScansWithoutReturnsAreCountedAndAQuarterOfThemIsTooMany) {
  const test::RoomWorld office = test::make_office();
  const RandomStream noise(1, "test/consistency");
  const std::vector<test::DriveStep> steps = test::drive_along(test::office_rounds(2), {.speed_mps = 1.5});
  const auto drive_with = [&](std::size_t num_without_returns) {
    Drive drive;
    for (const test::DriveStep& step : steps) {
      const std::size_t k = drive.T_map_body.size();
      LevelScan scan = office.scan(step.T_world_body, step.stamp, test::kOldLidar, noise, k);
      const bool has_returns = k < 10 || k >= 10 + num_without_returns;
      for (LevelScan::Beam& beam : scan.beams) beam.is_hit = beam.is_hit && has_returns;
      SlamUpdate update{.T_map_body = step.T_world_body};
      if (has_returns) update.match_score = 0.9;
      drive.T_map_body.push_back(step.T_world_body);
      drive.check.add(scan, update);
    }
    return drive.check.check(drive.T_map_body);
  };
  const MapConsistency few = drive_with(5), many = drive_with(steps.size() / 4);
  EXPECT_TRUE(few.is_consistent());
  EXPECT_EQ(few.num_without_returns, 5U);
  EXPECT_EQ(few.max_without_returns.first_scan, 10U);
  EXPECT_EQ(few.max_without_returns.num_scans, 5U);
  EXPECT_EQ(few.num_unmatched, 0U);
  EXPECT_TRUE(many.has_too_many_without_returns());
  EXPECT_FALSE(many.is_consistent());
}

TEST(MapConsistency, OfAMethodWithoutMatchScoresCountsNoScanAsUnmatched) {
  const test::RoomWorld office = test::make_office();
  const RandomStream noise(1, "test/consistency");
  ConsistencyCheck check;
  std::vector<Pose2> T_map_body;
  for (const test::DriveStep& step : test::drive_along(test::office_rounds(1), {.speed_mps = 1.5})) {
    check.add(office.scan(step.T_world_body, step.stamp, test::kOldLidar, noise, T_map_body.size()),
              {.T_map_body = step.T_world_body});
    T_map_body.push_back(step.T_world_body);
  }
  EXPECT_EQ(check.check(T_map_body).num_unmatched, 0U);
}

TEST(MapConsistency, OfNoScanAndOfASingleOneIsNotConsistent) {
  EXPECT_FALSE(ConsistencyCheck().check({}).is_consistent());
  ConsistencyCheck one;
  one.add(test::make_office().scan({4.2, 4.2, 0.0}, {}, test::kOldLidar, RandomStream(1, "test/consistency"), 0), {});
  const MapConsistency result = one.check({{4.2, 4.2, 0.0}});
  EXPECT_FALSE(result.is_consistent());
  EXPECT_EQ(result.num_segments, 1);
  EXPECT_EQ(result.num_compared, 0);
}

}  // namespace
}  // namespace patrol::slam::map_consistency_test
