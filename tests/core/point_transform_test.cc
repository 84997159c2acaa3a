#include "core/point_transform.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace patrol::point_transform_test {
namespace {

TEST(PointTransform, EqualsTheProductOfPoseAndPointToTheBit) {
  const RandomStream stream(1, "test/point_transform");
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const Pose2 T_a_b{100.0 * stream.uniform(i, 0) - 50.0, 100.0 * stream.uniform(i, 1) - 50.0,
                      8.0 * stream.uniform(i, 2) - 4.0};
    const Eigen::Vector2d p_b(60.0 * stream.uniform(i, 3) - 30.0, 60.0 * stream.uniform(i, 4) - 30.0);
    EXPECT_EQ(PointTransform(T_a_b)(p_b), T_a_b * p_b);
  }
}

}  // namespace
}  // namespace patrol::point_transform_test
