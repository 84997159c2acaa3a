#include "localize/pending_readings.h"

#include <vector>

#include <gtest/gtest.h>

#include "localize/frozen_readings.h"

namespace patrol::localize::pending_readings_test {
namespace {

using namespace std::chrono_literals;

struct Reading {
  Time stamp{};
  int id = 0;
};

TEST(PendingReadings, AreInOrderOfStampsAndOfArrivalWithinAStamp) {
  PendingReadings<Reading> pending;
  for (const Reading& reading : {Reading{3s, 0}, Reading{1s, 1}, Reading{3s, 2}, Reading{2s, 3}})
    pending.insert(reading);
  EXPECT_EQ(pending.newest().id, 2);
  std::vector<int> ids;
  for (; !pending.is_empty(); pending.pop_oldest()) ids.push_back(pending.oldest().id);
  EXPECT_EQ(ids, (std::vector<int>{1, 3, 0, 2}));
}

TEST(PendingReadings, AreFullAtTheirLimit) {
  PendingReadings<Reading> pending;
  int count = 0;
  for (; !pending.is_full(); ++count) pending.insert({Time(count), count});
  EXPECT_EQ(count, 256);
  pending.clear();
  EXPECT_TRUE(pending.is_empty());
}

TEST(FrozenReadings, TenRepeatsAreFrozenAndAChangeEndsThem) {
  FrozenReadings<2> frozen;
  const Eigen::Vector2d reading(1.0, 2.0);
  for (int i = 0; i <= 9; ++i) EXPECT_FALSE(frozen.is_frozen(reading)) << i;
  EXPECT_TRUE(frozen.is_frozen(reading));
  EXPECT_FALSE(frozen.is_frozen({1.0, 2.1}));
}

}  // namespace
}  // namespace patrol::localize::pending_readings_test
