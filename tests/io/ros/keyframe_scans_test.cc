#include <string>

#include <gtest/gtest.h>

#include "io/ros/point_cloud2.h"
#include "io/ros/ros_messages.h"

namespace patrol::io::keyframe_scans_test {
namespace {

KeyframeScans two_scans() {
  KeyframeScans keyframe{.stamp = from_seconds(12.5), .scans = {}};
  keyframe.scans.push_back(
      {.stamp = keyframe.stamp,
       .origin_m = {0.25, -0.5},
       .beams = {{.end_m = {3.1F, 0.2F}, .is_hit = true}, {.end_m = {-8.0F, 1.0F}, .is_hit = false}}});
  keyframe.scans.push_back(
      {.stamp = keyframe.stamp, .origin_m = {0.5, 0.0}, .beams = {{.end_m = {1.0F, 2.0F}, .is_hit = true}}});
  return keyframe;
}

TEST(KeyframeScans, AreDecodedAsTheyWereEncoded) {
  const KeyframeScans keyframe = two_scans();
  const auto read = decode<KeyframeScans>(encode(keyframe));
  EXPECT_EQ(read.stamp, keyframe.stamp);
  ASSERT_EQ(read.scans.size(), 2U);
  for (std::size_t s = 0; s < 2; ++s) {
    EXPECT_EQ(read.scans[s].stamp, keyframe.stamp);
    EXPECT_EQ(read.scans[s].origin_m, keyframe.scans[s].origin_m);
    ASSERT_EQ(read.scans[s].beams.size(), keyframe.scans[s].beams.size());
    for (std::size_t i = 0; i < read.scans[s].beams.size(); ++i) {
      EXPECT_EQ(read.scans[s].beams[i].end_m, keyframe.scans[s].beams[i].end_m);
      EXPECT_EQ(read.scans[s].beams[i].is_hit, keyframe.scans[s].beams[i].is_hit);
    }
  }
}

TEST(KeyframeScans, WithoutBeamsAreOneEmptyScan) {
  const auto read = decode<KeyframeScans>(encode(KeyframeScans{.stamp = from_seconds(1.0), .scans = {{}}}));
  ASSERT_EQ(read.scans.size(), 1U);
  EXPECT_EQ(read.scans[0].stamp, from_seconds(1.0));
  EXPECT_TRUE(read.scans[0].beams.empty());
}

TEST(KeyframeScans, AreAPointCloudForOtherReaders) {
  const PointCloud cloud = decode_point_cloud(encode(two_scans()));
  ASSERT_EQ(cloud.points.size(), 3U);
  EXPECT_EQ(cloud.points[1].x, -8.0F);
  EXPECT_EQ(cloud.points[2].y, 2.0F);
}

TEST(KeyframeScans, BytesThatAreNoneAreRefused) {
  const std::string bytes = encode(two_scans());
  EXPECT_THROW(decode<KeyframeScans>(bytes.substr(0, bytes.size() / 2)), DecodeError);
  EXPECT_THROW(decode<KeyframeScans>(encode(PointCloud{})), DecodeError);
  KeyframeScans infinite = two_scans();
  infinite.scans[0].beams[0].end_m.x() = std::numeric_limits<float>::infinity();
  EXPECT_THROW(decode<KeyframeScans>(encode(infinite)), DecodeError);
}

}  // namespace
}  // namespace patrol::io::keyframe_scans_test
