#include "core/geometry/segment.h"

#include <gtest/gtest.h>

namespace patrol::segment_test {
namespace {

constexpr double kExactTol = 1e-12;

TEST(DistanceToSegment, IsToItsSideItsEndsOrThePointThatItIs) {
  EXPECT_NEAR(distance_to_segment({2.0, 3.0}, {0.0, 0.0}, {4.0, 0.0}), 3.0, kExactTol);
  EXPECT_NEAR(distance_to_segment({7.0, 4.0}, {0.0, 0.0}, {4.0, 0.0}), 5.0, kExactTol);
  EXPECT_NEAR(distance_to_segment({-3.0, -4.0}, {0.0, 0.0}, {4.0, 0.0}), 5.0, kExactTol);
  EXPECT_NEAR(distance_to_segment({1.0, 1.0}, {0.0, 0.0}, {2.0, 2.0}), 0.0, kExactTol);
  EXPECT_NEAR(distance_to_segment({3.0, 4.0}, {0.0, 0.0}, {0.0, 0.0}), 5.0, kExactTol);
}

}  // namespace
}  // namespace patrol::segment_test
