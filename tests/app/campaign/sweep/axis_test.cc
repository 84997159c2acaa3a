#include "app/campaign/sweep/axis.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/moments.h"

namespace patrol::app::axis_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

double drawn(const Axis& axis, std::uint64_t seed) { return std::stod(axis.sample(seed).substr(axis.path.size() + 1)); }

std::string message_of(const std::string& text) {
  try {
    parse_axis(text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Axis, AListKeepsItsValuesAsTheyWereWritten) {
  const Axis axis = parse_axis("stack.slam.rbpf.particles=10,20,50");
  EXPECT_EQ(axis.path, "stack.slam.rbpf.particles");
  EXPECT_THAT(axis.values, ElementsAre("10", "20", "50"));
  EXPECT_FALSE(axis.is_random());
}

TEST(Axis, CommasInBracketsAndQuotesDoNotPart) {
  EXPECT_THAT(parse_axis("faults=[],[{sensor: imu, kind: freeze}]").values,
              ElementsAre("[]", "[{sensor: imu, kind: freeze}]"));
  EXPECT_THAT(parse_axis("a='x,y',z").values, ElementsAre("'x,y'", "z"));
}

TEST(Axis, ARangeOfFiveFromZeroToOneStepsByAQuarter) {
  EXPECT_THAT(parse_axis("a=range:0:1:5").values, ElementsAre("0", "0.25", "0.5", "0.75", "1"));
  EXPECT_THAT(parse_axis("a=range:0.1:0.3:3").values, ElementsAre("0.1", "0.2", "0.3"));
}

TEST(Axis, ALogRangeStepsInEqualRatios) {
  EXPECT_THAT(parse_axis("a=logrange:0.01:1:3").values, ElementsAre("0.01", "0.1", "1"));
}

TEST(Axis, AUniformDrawHasTheMeanAndSpreadOfItsInterval) {
  const Axis axis = parse_axis("a=uniform:2:4");
  test::Moments moments;
  for (std::uint64_t seed = 1; seed <= 10000; ++seed) moments.add(drawn(axis, seed));
  // Variance of a uniform: (b - a)^2 / 12 = 1/3; the mean's standard error is 0.577 / 100.
  EXPECT_NEAR(moments.mean(), 3.0, 4.0 * 0.00577);
  EXPECT_NEAR(moments.std(), std::sqrt(1.0 / 3.0), 0.01);
}

TEST(Axis, ANormalDrawHasItsMeanAndStandardDeviation) {
  const Axis axis = parse_axis("a=normal:5:0.5");
  test::Moments moments;
  for (std::uint64_t seed = 1; seed <= 10000; ++seed) moments.add(drawn(axis, seed));
  EXPECT_NEAR(moments.mean(), 5.0, 4.0 * 0.005);
  EXPECT_NEAR(moments.std(), 0.5, 4.0 * 0.5 / std::sqrt(20000.0));
}

TEST(Axis, TheSameSeedDrawsTheSameAndAnotherPathAnother) {
  const Axis a = parse_axis("a=uniform:0:1"), b = parse_axis("b=uniform:0:1");
  EXPECT_EQ(a.sample(7), a.sample(7));
  EXPECT_NE(drawn(a, 7), drawn(a, 8));
  EXPECT_NE(drawn(a, 7), drawn(b, 7));
}

TEST(Axis, ALogUniformDrawStaysBetweenItsEnds) {
  const Axis axis = parse_axis("a=loguniform:0.001:10");
  int below_the_middle = 0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    const double value = drawn(axis, seed);
    EXPECT_GE(value, 0.001);
    EXPECT_LE(value, 10.0);
    below_the_middle += value < 0.1 ? 1 : 0;  // half of the decades: a fair coin, standard deviation 16
  }
  EXPECT_NEAR(below_the_middle, 500, 64);
}

TEST(Axis, WhatIsWrongIsSaid) {
  EXPECT_THAT(message_of("no_values"), HasSubstr("must be path=a,b,c"));
  EXPECT_THAT(message_of("a="), HasSubstr("at least one value"));
  EXPECT_THAT(message_of("a=1,,2"), HasSubstr("empty"));
  EXPECT_THAT(message_of("a=1,2,1"), HasSubstr("duplicate value '1'"));
  EXPECT_THAT(message_of("a=range:0:1"), HasSubstr("range:FROM:TO:N"));
  EXPECT_THAT(message_of("a=range:0:x:3"), HasSubstr("'x' is not a number"));
  EXPECT_THAT(message_of("a=range:0:1:1"), HasSubstr("[2, 10000]"));
  EXPECT_THAT(message_of("a=logrange:0:1:3"), HasSubstr("greater than 0"));
  EXPECT_THAT(message_of("a=uniform:1:0"), HasSubstr("HIGH must not be less than LOW"));
  EXPECT_THAT(message_of("a=loguniform:0:1"), HasSubstr("LOW must be greater than 0"));
  EXPECT_THAT(message_of("a=normal:0:-1"), HasSubstr("negative"));
}

TEST(Cross, TwoMethodsAndThreeNoisesAreSixVariantsTheFirstAxisSlowest) {
  const std::vector<Variant> variants =
      cartesian_product({parse_axis("m=a,b"), parse_axis("n=1,2,3"), parse_axis("d=uniform:0:1")});
  ASSERT_EQ(variants.size(), 6u);
  EXPECT_EQ(variants[0].name, "m=a, n=1");
  EXPECT_EQ(variants[2].name, "m=a, n=3");
  EXPECT_EQ(variants[3].name, "m=b, n=1");
  EXPECT_THAT(variants[5].overrides, ElementsAre("m=b", "n=3"));
}

TEST(Cross, NothingVariedIsOneVariant) {
  ASSERT_EQ(cartesian_product({}).size(), 1u);
  EXPECT_EQ(cartesian_product({}).front().name, "baseline");
}

TEST(Cross, AnAxisTwiceIsRefused) {
  EXPECT_THROW(cartesian_product({parse_axis("a=1,2"), parse_axis("a=3,4")}), InputError);
}

}  // namespace
}  // namespace patrol::app::axis_test
