#include "sim/sensors/delivery_queue.h"

#include <vector>

#include <gtest/gtest.h>

namespace patrol::sim::delivery_queue_test {
namespace {

TEST(DeliveryQueue, DeliversInOrderOfTheInstantDueAndAtOneInstantInTheOrderPutIn) {
  DeliveryQueue queue;
  const auto tagged = [](int anchor) { return QueuedMessage{.message = UwbRange{.stamp = {}, .anchor = anchor}}; };
  queue.push(from_seconds(2.0), tagged(1));
  queue.push(from_seconds(1.0), tagged(2));
  queue.push(from_seconds(2.0), tagged(3));
  queue.push(from_seconds(3.0), tagged(4));
  std::vector<int> order;
  for (const QueuedMessage& queued : queue.take_due(from_seconds(2.0)))
    order.push_back(std::get<UwbRange>(queued.message).anchor);
  EXPECT_EQ(order, (std::vector<int>{2, 1, 3}));
  EXPECT_TRUE(queue.take_due(from_seconds(2.5)).empty());
  EXPECT_EQ(queue.take_due(from_seconds(3.0)).size(), 1u);
}

}  // namespace
}  // namespace patrol::sim::delivery_queue_test
