#include "io/json/json_check.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace patrol::io::json_check_test {
namespace {

std::string complaint_about(const std::string& text, std::size_t max_entries = 3) {
  try {
    check_json("f.json", text, max_entries);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(CheckJson, AsManyEntriesAsAllowedAreTakenInEachList) {
  EXPECT_EQ(complaint_about(R"([1, [1, 2, 3], {"a": [1, 2, 3], "b": {"a": [null, true, "x"]}}])"), "");
  EXPECT_EQ(complaint_about("2.5"), "");
}

TEST(CheckJson, WhatIsNotJsonIsNamedByLineAndColumn) {
  EXPECT_EQ(complaint_about("{\n \"a\": NaN}"), "f.json:2: is not JSON at column 7");
  EXPECT_EQ(complaint_about("x"), "f.json:1: is not JSON at column 1");
  EXPECT_EQ(complaint_about("[1]\n x"), "f.json:2: is not JSON at column 2");
  EXPECT_EQ(complaint_about("[\"a\nb\"]"), "f.json:1: is not JSON at column 4");
  EXPECT_EQ(complaint_about("[\"\xff\"]"), "f.json:1: is not JSON at column 3");
}

TEST(CheckJson, WhatEndsTooEarlyIsSaidToDoSo) {
  EXPECT_EQ(complaint_about(""), "f.json:1: is not JSON: ends too early");
  EXPECT_EQ(complaint_about("[1,\n{\"a\":"), "f.json:2: is not JSON: ends too early");
}

TEST(CheckJson, ANumberTooLargeIsQuoted) {
  EXPECT_EQ(complaint_about("[1,\n\n-1e400\n]"), "f.json:3: -1e400: number out of range");
}

TEST(CheckJson, AKeyTwiceInOneObjectIsNamedWithItsPlace) {
  EXPECT_EQ(complaint_about(R"({"a": 1, "a": 2})"), "f.json: a: duplicate key");
  EXPECT_EQ(complaint_about(R"({"w": [1, {"b": 2, "a": 1, "b": 2}]})"), "f.json: w[1]: b: duplicate key");
  EXPECT_EQ(complaint_about(R"([{"a": 1}, {"a": 1}])"), "");
}

TEST(CheckJson, TheFirstEntryTooManyIsRefused) {
  EXPECT_EQ(complaint_about("[1, 2, 3, 4"), "f.json: more than 3 entries") << "before the end is looked for";
  EXPECT_EQ(complaint_about(R"({"w": [1, {"a": [1, [], {}, 4]}]})"), "f.json: w[1].a: more than 3 entries");
}

TEST(CheckJson, TwentyLevelsAreDeepEnough) {
  EXPECT_EQ(complaint_about(std::string(20, '[') + std::string(20, ']')), "");
  EXPECT_TRUE(complaint_about(std::string(1000000, '[')).ends_with("more than 20 nested levels"));
}

}  // namespace
}  // namespace patrol::io::json_check_test
