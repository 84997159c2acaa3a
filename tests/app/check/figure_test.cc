#include "app/check/figure.h"

#include <limits>

#include <gtest/gtest.h>

namespace patrol::app::figure_test {
namespace {

TEST(CheckFigure, IsMetAtItsLimitsAndNotBeyond) {
  const auto is_met = [](double value) {
    return Figure{.name = "slip_ratio", .value = value, .min = 0.0, .max = 0.1}.is_met();
  };
  EXPECT_TRUE(is_met(0.0));
  EXPECT_TRUE(is_met(0.1));
  EXPECT_FALSE(is_met(-1e-9));
  EXPECT_FALSE(is_met(0.1 + 1e-9));
}

TEST(CheckFigure, AValueThatIsNotANumberIsNotMet) {
  EXPECT_FALSE((Figure{.name = "slip_ratio", .value = std::numeric_limits<double>::quiet_NaN(), .max = 0.1}.is_met()));
}

TEST(CheckFigure, WithoutLimitsIsMet) {
  const Figure figure{.name = "stop_time_s", .value = 1.3};
  EXPECT_TRUE(figure.is_met());
  EXPECT_EQ(limit_text(figure), "");
}

TEST(CheckFigure, HasTextsWithTheUnitOfItsName) {
  EXPECT_EQ(label_of({.name = "heading_drift_deg"}), "heading drift");
  EXPECT_EQ(label_of({.name = "slip_ratio"}), "slip ratio");
  EXPECT_EQ(value_text({.name = "heading_drift_deg", .value = -1.5}), "-1.50°");
  EXPECT_EQ(value_text({.name = "stop_distance_m", .value = 0.512}), "51.2 cm");
  EXPECT_EQ(value_text({.name = "speed_mps", .value = 1.0}), "1.00 m/s");
  EXPECT_EQ(limit_text({.name = "speed_mps", .min = 0.85}), "at least 0.85 m/s");
  EXPECT_EQ(limit_text({.name = "creep_m", .max = 0.02}), "at most 2.0 cm");
  EXPECT_EQ(limit_text({.name = "yaw_rate_ratio", .min = 0.85, .max = 1.15}), "0.850 to 1.150");
}

TEST(Figure, AValueThatMissesItsLimitByLessThanTheUsualDigitsHasMoreOfThem) {
  const Figure speed{.name = "speed_mps", .value = 0.9841, .min = 0.9849};
  EXPECT_EQ(value_text(speed) + ": " + limit_text(speed), "0.984 m/s: at least 0.985 m/s");
  const Figure creep{.name = "creep_m", .value = 0.02003, .max = 0.02};
  EXPECT_EQ(value_text(creep) + ": " + limit_text(creep), "0.02003 m: at most 0.02000 m");
  const Figure ratio{.name = "yaw_rate_ratio", .value = 1.0, .min = 0.85, .max = 1.15};
  EXPECT_EQ(value_text(ratio), "1.000");
}

}  // namespace
}  // namespace patrol::app::figure_test
