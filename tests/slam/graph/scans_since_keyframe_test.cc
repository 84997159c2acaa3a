#include "slam/graph/scans_since_keyframe.h"

#include <gtest/gtest.h>

namespace patrol::slam::scans_since_keyframe_test {
namespace {

LevelScan scan_at(double seconds) { return {.stamp = from_seconds(seconds), .beams = {}}; }

TEST(ScansSinceKeyframe, OfFourScansTwoInTheSamePlaceThreeAreKeptAndTheNewestOfBoth) {
  ScansSinceKeyframe scans;
  scans.add(scan_at(1.0), {0.0, 0.0, 0.0});
  scans.add(scan_at(2.0), {0.1, 0.0, 0.0});
  scans.add(scan_at(3.0), {0.2, 0.0, 0.0});
  scans.add(scan_at(4.0), {0.24, 0.0, 0.0});
  const ScanGroup group = scans.take();
  EXPECT_EQ(group.num_scans(), 3U);
  EXPECT_EQ(group.stamp(), from_seconds(4.0));
  EXPECT_TRUE(scans.is_empty());
}

TEST(ScansSinceKeyframe, SlowMotionIsMeasuredFromTheLastDistinctPlaceAndATurnCounts) {
  ScansSinceKeyframe scans;
  for (int k = 0; k < 7; ++k) scans.add(scan_at(k), {0.02 * k, 0.0, 0.0});  // distinct: 0, 0.06, 0.12 m
  scans.add(scan_at(8.0), {0.12, 0.0, 0.06});
  EXPECT_EQ(scans.take().num_scans(), 4U);
}

}  // namespace
}  // namespace patrol::slam::scans_since_keyframe_test
