#include "app/campaign/sweep/sweep_options.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace patrol::app::sweep_options_test {
namespace {

using ::testing::ElementsAre;

TEST(SweepOptions, SeedsAreACountOrARange) {
  EXPECT_THAT(parse_seeds("3"), ElementsAre(1, 2, 3));
  EXPECT_THAT(parse_seeds("11..13"), ElementsAre(11, 12, 13));
  for (const char* wrong : {"", "0", "-1", "x", "3..1", "1..", "..3", "1e3", "1..9999999"})
    EXPECT_THROW(parse_seeds(wrong), InputError) << wrong;
}

TEST(SweepOptions, AnyNumberOfShardsHoldsEveryRunOnce) {
  for (const std::size_t count : {1u, 3u, 7u}) {
    std::multiset<std::size_t> held;
    for (std::size_t i = 1; i <= count; ++i) {
      const Shard shard = parse_shard(std::to_string(i) + "/" + std::to_string(count));
      for (std::size_t run = 0; run < 20; ++run) {
        if (shard.contains(run)) held.insert(run);
      }
    }
    EXPECT_EQ(held.size(), 20u);
    EXPECT_EQ(std::set(held.begin(), held.end()).size(), 20u);
  }
  for (const char* wrong : {"0/3", "4/3", "1", "1/", "/3", "a/b"})
    EXPECT_THROW(parse_shard(wrong), InputError) << wrong;
}

}  // namespace
}  // namespace patrol::app::sweep_options_test
