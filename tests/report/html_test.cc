#include "report/html.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patrol::report::html_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(ScriptJson, CannotEndTheScriptThatHoldsIt) {
  const std::string json = script_json({{"text", "</script><script>alert(1)</script><!--"}});
  EXPECT_THAT(json, Not(HasSubstr("<")));
  EXPECT_EQ(nlohmann::ordered_json::parse(json)["text"], "</script><script>alert(1)</script><!--");
}

TEST(ScriptJson, TakesBytesThatAreNotUtf8) { EXPECT_EQ(script_json({{"text", "\xff"}}), R"({"text":"\ufffd"})"); }

// RFC 4648, section 10.
TEST(DataUri, IsTheStandardsOwnExamples) {
  EXPECT_EQ(data_uri("a/b", ""), "data:a/b;base64,");
  EXPECT_EQ(data_uri("a/b", "f"), "data:a/b;base64,Zg==");
  EXPECT_EQ(data_uri("a/b", "fo"), "data:a/b;base64,Zm8=");
  EXPECT_EQ(data_uri("a/b", "foobar"), "data:a/b;base64,Zm9vYmFy");
  EXPECT_EQ(data_uri("a/b", "\xff\xfe\xfd"), "data:a/b;base64,//79");
}

}  // namespace
}  // namespace patrol::report::html_test
