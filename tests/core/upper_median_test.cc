#include "core/upper_median.h"

#include <gtest/gtest.h>

namespace patrol::upper_median_test {
namespace {

TEST(UpperMedian, OfThreeValuesIsTheSecondAndOfFourTheThird) {
  EXPECT_EQ(upper_median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(upper_median({4.0, 1.0, 3.0, 2.0}), 3.0);
  EXPECT_EQ(upper_median({5.0}), 5.0);
}

}  // namespace
}  // namespace patrol::upper_median_test
