#include "core/geometry/angles.h"

#include <gtest/gtest.h>

namespace patrol::angles_test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kExactTol = 1e-15;

TEST(Angles, KnownAnglesConvertExactly) {
  EXPECT_EQ(to_rad(180.0), kPi);
  EXPECT_EQ(to_rad(-90.0), -kPi / 2.0);
  EXPECT_EQ(to_rad(360.0), 2.0 * kPi);
  EXPECT_EQ(to_deg(kPi), 180.0);
  EXPECT_EQ(to_deg(-kPi / 4.0), -45.0);
  EXPECT_EQ(to_rad(0.0), 0.0);
}

TEST(Angles, ConstantsAndFunctionsAgree) {
  for (double angle_deg = -720.0; angle_deg <= 720.0; angle_deg += 0.37) {
    EXPECT_NEAR(angle_deg * kDegree, to_rad(angle_deg), 20.0 * kExactTol);
    EXPECT_NEAR(kDegPerRad * to_rad(angle_deg), angle_deg, 1000.0 * kExactTol);
    EXPECT_NEAR(to_deg(to_rad(angle_deg)), angle_deg, 1000.0 * kExactTol);
  }
}

}  // namespace
}  // namespace patrol::angles_test
