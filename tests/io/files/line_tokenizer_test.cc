#include "io/files/line_tokenizer.h"

#include <cmath>

#include <gtest/gtest.h>

namespace patrol::io::line_fields_test {
namespace {

using namespace std::chrono_literals;

template <typename Read>
std::string complaint_about(const std::string& line, const Read& read) {
  LineTokenizer fields(line);
  try {
    read(fields);
  } catch (const ParseError& error) {
    return error.what();
  }
  return "";
}

TEST(ParseStamp, SecondsSinceNineteenSeventyKeepTheirNanoseconds) {
  EXPECT_EQ(parse_stamp("976052857.222433"), Time(976'052'857'222'433'000));
  EXPECT_EQ(parse_stamp("1232658478.161285123"), Time(1'232'658'478'161'285'123));
  EXPECT_EQ(parse_stamp("0.000000001"), 1ns);
  EXPECT_EQ(parse_stamp("-1.5"), Time(-1500ms));
  EXPECT_EQ(parse_stamp("12"), 12s);
  EXPECT_EQ(parse_stamp("12."), 12s);
}

TEST(ParseStamp, DigitsBeyondTheNinthAreCutOff) { EXPECT_EQ(parse_stamp("1.0000000019"), 1s + 1ns); }

TEST(ParseStamp, OtherWaysToWriteANumberAreReadToo) {
  EXPECT_EQ(parse_stamp(".5"), 500ms);
  EXPECT_EQ(parse_stamp("1e3"), 1000s);
  EXPECT_EQ(parse_stamp("+2.5"), 2500ms);
}

TEST(ParseStamp, WhatIsNoTimeOfUseIsNone) {
  for (const char* const text : {"", ".", "-", "1.2.3", "1.5s", "nan", "inf", "1e300", "99999999999",
                                 "99999999999999999999999", "0x10", "1.-5"}) {
    EXPECT_EQ(parse_stamp(text), std::nullopt) << text;
  }
}

TEST(LineTokenizer, TakesWordsBetweenBlanks) {
  LineTokenizer fields("  one\ttwo  3.5 -1e-2 \r");
  EXPECT_EQ(fields.num_words(), 4U);
  EXPECT_EQ(fields.word("a"), "one");
  EXPECT_EQ(fields.word("b"), "two");
  EXPECT_EQ(fields.number("c"), 3.5);
  EXPECT_EQ(fields.num_words(), 1U);
  EXPECT_EQ(fields.number("d"), -0.01);
  EXPECT_TRUE(fields.is_empty());
  EXPECT_EQ(fields.num_words(), 0U);
}

TEST(LineTokenizer, AnyNumberMayBeInfiniteOrNoneButNumberMayNot) {
  LineTokenizer fields("inf nan +1.5");
  EXPECT_TRUE(std::isinf(fields.any_number("a")));
  EXPECT_TRUE(std::isnan(fields.any_number("b")));
  EXPECT_EQ(fields.any_number("c"), 1.5);
  EXPECT_EQ(complaint_about("nan", [](LineTokenizer& f) { f.number("x"); }), "x 'nan' is not a finite number");
  EXPECT_EQ(complaint_about("-inf", [](LineTokenizer& f) { f.number("x"); }), "x '-inf' is not a finite number");
}

TEST(LineTokenizer, NamesWhatIsNoNumber) {
  EXPECT_EQ(complaint_about("1,5", [](LineTokenizer& f) { f.any_number("range"); }), "range '1,5' is not a number");
  EXPECT_EQ(complaint_about("", [](LineTokenizer& f) { f.number("range"); }), "ends before range");
  EXPECT_EQ(complaint_about("1.5x", [](LineTokenizer& f) { f.stamp("t"); }), "t '1.5x' is not a time in seconds");
  EXPECT_EQ(complaint_about("1e12", [](LineTokenizer& f) { f.stamp("t"); }),
            "t '1e12' is out of range: must be at most 9e+09 s");
  EXPECT_EQ(complaint_about("-1e9", [](LineTokenizer& f) { f.distance("x"); }), "x -1e+09 m is off the earth");
  EXPECT_EQ(complaint_about("11", [](LineTokenizer& f) { f.integer("n", 0, 10); }),
            "n '11' must be an integer in [0, 10]");
  EXPECT_EQ(complaint_about("1.0", [](LineTokenizer& f) { f.integer("n", 0, 10); }),
            "n '1.0' must be an integer in [0, 10]");
  EXPECT_EQ(complaint_about(std::string(100, 'x'), [](LineTokenizer& f) { f.number("n"); }),
            "n '" + std::string(24, 'x') + "...' is not a finite number");
}

TEST(LineTokenizer, APoseIsWrappedAndOnTheEarth) {
  LineTokenizer fields("1 2 7");
  const Pose2 pose = fields.pose("pose");
  EXPECT_EQ(pose.x, 1.0);
  EXPECT_EQ(pose.y, 2.0);
  EXPECT_NEAR(pose.yaw, 7.0 - 2.0 * std::numbers::pi, 1e-15);
  EXPECT_EQ(complaint_about("1e300 0 0", [](LineTokenizer& f) { f.pose("pose"); }),
            "pose (1e+300 m, 0 m) is off the earth");
}

}  // namespace
}  // namespace patrol::io::line_fields_test
