#include "app/campaign/sweep/slurm_engine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patrol::app::slurm_engine_test {
namespace {

using ::testing::HasSubstr;

TEST(SlurmEngine, OnlyShardsWithMissingRunsAreSubmittedAgain) {
  EXPECT_EQ(shards_with_work({0, 1, 2, 3, 4, 5}, 3), "1,2,3");
  EXPECT_EQ(shards_with_work({4, 7}, 3), "2");  // 4 and 7 leave 1 when divided by 3
}

TEST(SlurmEngine, AShardsCommandIsTheCallWithItsOptions) {
  SweepOptions options;
  options.scenario = "/s/it's.yaml";
  options.vary = {"a=[1, 2],3"};
  options.batch.jobs = 2;
  options.out = "/o";
  const std::string command = shard_command(options, "/bin/patrol", "2/3");
  EXPECT_THAT(command, HasSubstr("'/bin/patrol' sweep '/s/it'\\''s.yaml'"));
  EXPECT_THAT(command, HasSubstr("--vary 'a=[1, 2],3'"));
  EXPECT_THAT(command, HasSubstr("--jobs 2"));
  EXPECT_THAT(command, HasSubstr("--shard 2/3"));
}

}  // namespace
}  // namespace patrol::app::slurm_engine_test
