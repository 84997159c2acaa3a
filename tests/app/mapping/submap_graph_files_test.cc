#include "app/mapping/submap_graph_files.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/temporary_file.h"

namespace patrol::app::submap_graph_files_test {
namespace {

using ::testing::HasSubstr, ::testing::ThrowsMessage;

/// Three keyframes in two submaps; the second keyframe has two scans.
slam::SubmapGraph small_map() {
  const auto scan = [](float x_m, double stamp_s) {
    return LevelScan{.stamp = from_seconds(stamp_s),
                     .origin_m = {0.1, 0.0},
                     .beams = {{.end_m = {x_m, 0.5F}, .is_hit = true}, {.end_m = {x_m, -9.0F}, .is_hit = false}}};
  };
  std::vector<slam::ScanGroup> scans = {slam::ScanGroup(scan(1.0F, 5.0)), slam::ScanGroup(scan(2.0F, 6.0)),
                                        slam::ScanGroup(scan(3.0F, 4.0))};  // a later session may have earlier stamps
  scans[1].add(scan(2.5F, 6.5), {0.25, 0.0, 0.0});
  PoseGraph graph{.T_map_node = {{}, {1.0, 0.25, 0.5}, {2.0, 0.0, -3.0}}, .edges = {}};
  for (int k = 1; k < 3; ++k) graph.edges.push_back({.from = k - 1, .to = k, .T_from_to = {1.0, 0.25, 0.5}});
  return slam::make_submap_graph(std::move(scans), {{.first = 0, .last = 1}, {.first = 1, .last = 2}}, graph);
}

TEST(SubmapGraphFiles, AMapIsReadAsItWasWritten) {
  const test::TemporaryFolder folder;
  const slam::SubmapGraph map = small_map();
  save_submap_graph(folder.path(), map);
  const slam::SubmapGraph read = load_submap_graph(folder.path());
  ASSERT_EQ(read.keyframes.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(read.graph.T_map_node[k].x, map.graph.T_map_node[k].x);
    EXPECT_EQ(read.keyframes[k].T_local_body.yaw, map.graph.T_map_node[k].yaw);
    EXPECT_EQ(read.keyframes[k].scans.stamp(), map.keyframes[k].scans.stamp());
    const std::vector<LevelScan> scans = read.keyframes[k].scans.scans(), expected = map.keyframes[k].scans.scans();
    ASSERT_EQ(scans.size(), expected.size());
    for (std::size_t s = 0; s < scans.size(); ++s) {
      ASSERT_EQ(scans[s].beams.size(), 2U);
      EXPECT_EQ(scans[s].beams[0].end_m, expected[s].beams[0].end_m);
      EXPECT_NEAR(scans[s].origin_m.x(), expected[s].origin_m.x(), 1e-7);
    }
  }
  ASSERT_EQ(read.submaps.size(), 2U);
  EXPECT_EQ(read.submaps[1].first, 1);
  EXPECT_EQ(read.submaps[1].last, 2);
  ASSERT_EQ(read.graph.edges.size(), 2U);
}

TEST(SubmapGraphFiles, AFaultyFileIsNamed) {
  const test::TemporaryFolder folder;
  const auto load = [&] { load_submap_graph(folder.path()); };
  EXPECT_THAT(load, ThrowsMessage<InputError>(HasSubstr("keyframes.mcap")));
  save_submap_graph(folder.path(), small_map());
  const std::string submaps = test::read_bytes(folder / "submaps.csv"),
                    graph = test::read_bytes(folder / "pose_graph.g2o"),
                    keyframes = test::read_bytes(folder / "keyframes.mcap");
  EXPECT_EQ(submaps, "first_keyframe,last_keyframe\r\n0,1\r\n1,2\r\n");
  test::write_bytes(folder / "submaps.csv", "first_keyframe,last_keyframe\n0,1\n1;2\n");
  EXPECT_THAT(load, ThrowsMessage<InputError>(HasSubstr("submaps.csv:3: must be FIRST,LAST")));
  test::write_bytes(folder / "submaps.csv", "first_keyframe,last_keyframe\n0,1\n1,2 3\n");
  EXPECT_THAT(load, ThrowsMessage<InputError>(HasSubstr("submaps.csv:3: too many words")));
  test::write_bytes(folder / "submaps.csv", "first_keyframe,last_keyframe\n0,1\n1,3\n");
  EXPECT_THAT(load, ThrowsMessage<InputError>(HasSubstr("submap 1: invalid range of keyframes")));
  test::write_bytes(folder / "submaps.csv", submaps);
  test::write_bytes(folder / "pose_graph.g2o", "VERTEX_SE2 0 0 0 0\n");
  EXPECT_THAT(load, ThrowsMessage<InputError>(HasSubstr("3 keyframes, but 1 nodes of the pose graph")));
  test::write_bytes(folder / "pose_graph.g2o", graph);
  test::write_bytes(folder / "keyframes.mcap", keyframes.substr(0, keyframes.size() / 2));
  EXPECT_THAT(load, ThrowsMessage<InputError>(HasSubstr("keyframes.mcap: is truncated")));
  test::write_bytes(folder / "keyframes.mcap", keyframes);
  test::write_bytes(folder / "INCOMPLETE", "");
  EXPECT_THAT(load, ThrowsMessage<InputError>(HasSubstr("is incomplete")));
}

}  // namespace
}  // namespace patrol::app::submap_graph_files_test
