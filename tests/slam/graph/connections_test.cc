#include "slam/graph/connections.h"

#include <gtest/gtest.h>

namespace patrol::slam::connections_test {
namespace {

TEST(Connections, CountTheParts) {
  Connections connections(5);
  EXPECT_EQ(connections.num_parts(), 5U);
  connections.connect(0, 1);
  connections.connect(1, 2);
  connections.connect(2, 0);
  EXPECT_EQ(connections.num_parts(), 3U);
  EXPECT_TRUE(connections.are_connected(0, 2));
  EXPECT_FALSE(connections.are_connected(0, 3));
}

}  // namespace
}  // namespace patrol::slam::connections_test
