#include "app/campaign/batch/shared_beginning.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace patrol::app::shared_beginning_test {
namespace {

Scenario scenario_with(std::vector<std::string> overrides) {
  return load_scenario(PATROL_SOURCE_DIR "/worlds/street/scenarios/short.yaml", overrides);
}

const std::string kLidarAt12 = "{sensor: lidar, kind: dropout, start_s: 12}";
const std::string kImuAt5 = "{sensor: imu, kind: dropout, start_s: 5}";

TEST(SharedBeginnings, LaterFaultsAndKidnapsBranchFromTheFirstRunShortlyBeforeTheFirstEventThatDiffers) {
  const auto shared = shared_beginnings({scenario_with({"faults=[]"}), scenario_with({"faults=[" + kLidarAt12 + "]"}),
                                         scenario_with({"faults=[" + kLidarAt12 + "," + kImuAt5 + "]"}),
                                         scenario_with({"kidnaps=[{at_s: 8}]"}), scenario_with({"faults=[]"})},
                                        3.0);
  ASSERT_EQ(shared.size(), 5U);
  EXPECT_FALSE(shared[0]);
  const std::vector<double> first_s = {12.0, 5.0, 8.0};
  for (std::size_t i = 0; i < first_s.size(); ++i) {
    ASSERT_TRUE(shared[i + 1]) << i;
    EXPECT_EQ(shared[i + 1]->leader, 0U);
    EXPECT_LT(shared[i + 1]->until, from_seconds(first_s[i] - 0.002));
    EXPECT_GT(shared[i + 1]->until, from_seconds(first_s[i] - 0.1));
  }
  EXPECT_FALSE(shared[4]) << "no event differs";
}

TEST(SharedBeginnings, EarlierEventsInCommonAreShared) {
  const auto shared = shared_beginnings(
      {scenario_with({"faults=[" + kImuAt5 + "]"}), scenario_with({"faults=[" + kImuAt5 + "," + kLidarAt12 + "]"})},
      3.0);
  ASSERT_TRUE(shared[1]);
  EXPECT_GT(shared[1]->until, from_seconds(11.0));
}

TEST(SharedBeginnings, RunsThatDifferFromTheStartShareNothing) {
  const auto shared =
      shared_beginnings({scenario_with({}), scenario_with({"seed=2"}), scenario_with({"sensors.lidar.rate_hz=5"}),
                         scenario_with({"faults=[{sensor: lidar, start_s: 2}]"}),
                         scenario_with({"faults=[{sensor: lidar, start_s: 200}]"})},
                        3.0);
  for (const auto& one : shared) EXPECT_FALSE(one);
}

TEST(SharedBeginnings, ExpectationsDoNotMatter) {
  const auto shared = shared_beginnings(
      {scenario_with({}), scenario_with({"faults=[" + kLidarAt12 + "]", "expect.map.coverage={min: 0.1}"})}, 3.0);
  EXPECT_TRUE(shared[1]);
}

TEST(SharedBeginnings, RunsWithoutSnapshotsShareNothing) {
  const std::string fault = "faults=[" + kLidarAt12 + "]", method = "stack.slam.method=submap_rbpf";
  const auto shared = shared_beginnings({scenario_with({method}), scenario_with({method, fault})}, 3.0);
  EXPECT_FALSE(shared[1]);
}

}  // namespace
}  // namespace patrol::app::shared_beginning_test
