#include "app/sweep/sweep_options.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace patrol::app {
namespace {

using ::testing::ElementsAre;

SweepOptions street(const std::vector<std::string>& vary) {
  SweepOptions options;
  options.scenario = PATROL_SOURCE_DIR "/worlds/street/scenarios/short.yaml";
  options.vary = vary;
  options.seeds = "2";
  return options;
}

TEST(SweepOptions, SeedsAreACountOrARange) {
  EXPECT_THAT(parse_seeds("3"), ElementsAre(1, 2, 3));
  EXPECT_THAT(parse_seeds("11..13"), ElementsAre(11, 12, 13));
  for (const char* wrong : {"", "0", "-1", "x", "3..1", "1..", "..3", "1e3", "1..9999999"}) EXPECT_THROW(parse_seeds(wrong), InputError) << wrong;
}

TEST(SweepOptions, AnyNumberOfShardsHoldsEveryRunOnce) {
  for (const std::size_t count : {1u, 3u, 7u}) {
    std::multiset<std::size_t> held;
    for (std::size_t i = 1; i <= count; ++i) {
      const Shard shard = parse_shard(std::to_string(i) + "/" + std::to_string(count));
      for (std::size_t run = 0; run < 20; ++run) {
        if (shard.holds(run)) held.insert(run);
      }
    }
    EXPECT_EQ(held.size(), 20u);
    EXPECT_EQ(std::set(held.begin(), held.end()).size(), 20u);
  }
  for (const char* wrong : {"0/3", "4/3", "1", "1/", "/3", "a/b"}) EXPECT_THROW(parse_shard(wrong), InputError) << wrong;
}

TEST(PlanSweep, EveryRunHasAnAddressOfItsOwnAndItIsTheSameNextTime) {
  const SweepManifest manifest = plan_sweep(street({"sensors.lidar.range_noise_m=0.01,0.03"}));
  std::set<std::string> addresses;
  for (const PlannedRun& run : manifest.runs) addresses.insert(run.address);
  EXPECT_EQ(addresses.size(), 4u);
  EXPECT_EQ(plan_sweep(street({"sensors.lidar.range_noise_m=0.01,0.03"})).runs[3].address, manifest.runs[3].address);
}

TEST(PlanSweep, TheSameSettingsHaveTheSameAddressHoweverTheyAreSaid) {
  SweepOptions said = street({});
  said.overrides = {"sensors.lidar.range_noise_m=0.030"};
  EXPECT_EQ(plan_sweep(said).runs[0].address, plan_sweep(street({"sensors.lidar.range_noise_m=0.03"})).runs[0].address);
}

TEST(PlanSweep, ADrawIsCommonToTheVariantsOfASeed) {
  const SweepManifest manifest = plan_sweep(street({"stack.slam.particles=10,20", "sensors.lidar.range_noise_m=uniform:0.01:0.05"}));
  EXPECT_EQ(manifest.runs[0].overrides.back(), manifest.runs[1].overrides.back());
  EXPECT_NE(manifest.runs[0].overrides.back(), manifest.runs[2].overrides.back());
}

TEST(PlanSweep, AWrongKeyOrValueIsRefusedBeforeAnythingRuns) {
  EXPECT_THROW(plan_sweep(street({"sensors.lidar.range_nose_m=0.01,0.03"})), InputError);
  EXPECT_THROW(plan_sweep(street({"sensors.lidar.range_noise_m=0.01,-0.03"})), InputError);
}

}  // namespace
}  // namespace patrol::app
