#include "io/files/junit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::junit_test {
namespace {

using ::testing::HasSubstr, ::testing::Not;

std::string written(const std::vector<JunitSuite>& suites) {
  const test::TemporaryFolder folder;
  save_junit(folder / "junit.xml", suites);
  return test::read_bytes(folder / "junit.xml");
}

JunitCase make_case(const std::string& name, JunitResult result, const std::string& message = "") {
  return {.class_name = "short", .name = name, .time_s = 1.5, .result = result, .message = message, .details = ""};
}

TEST(SaveJunit, IsThisDocument) {
  EXPECT_EQ(written({{.name = "short",
                      .time_s = 3.0,
                      .properties = {{"seed", "7"}},
                      .cases = {make_case("mission.completed", JunitResult::kPassed),
                                make_case("pose.ate_rmse_m", JunitResult::kFailure, "0.2 m")}}}),
            R"(<?xml version="1.0" encoding="UTF-8"?>
<testsuites name="patrol" tests="2" failures="1" errors="0" skipped="0" time="3.000">
  <testsuite name="short" tests="2" failures="1" errors="0" skipped="0" time="3.000">
    <properties>
      <property name="seed" value="7"/>
    </properties>
    <testcase classname="short" name="mission.completed" time="1.500"/>
    <testcase classname="short" name="pose.ate_rmse_m" time="1.500">
      <failure message="0.2 m"/>
    </testcase>
  </testsuite>
</testsuites>
)");
}

TEST(SaveJunit, AddsTheSuitesUp) {
  const JunitSuite one{.name = "a",
                       .time_s = 1.0,
                       .properties = {},
                       .cases = {make_case("x", JunitResult::kError), make_case("y", JunitResult::kSkipped)}};
  const JunitSuite two{.name = "b", .time_s = 2.5, .properties = {}, .cases = {make_case("x", JunitResult::kPassed)}};
  EXPECT_THAT(written({one, two}),
              HasSubstr(R"(<testsuites name="patrol" tests="3" failures="0" errors="1" skipped="1" time="3.500">)"));
}

TEST(SaveJunit, EscapesWhatXmlCannotHold) {
  JunitCase test = make_case("a<b>&\"c\"", JunitResult::kFailure, "line 1\nline 2\t\x01\x1f end");
  test.details = "1 < 2 & \"so\"";
  const std::string xml = written({{.name = "s", .time_s = 0.0, .properties = {}, .cases = {test}}});
  EXPECT_THAT(xml, HasSubstr(R"(name="a&lt;b&gt;&amp;&quot;c&quot;")"));
  EXPECT_THAT(xml, HasSubstr(R"(message="line 1&#10;line 2&#9;   end")"));
  EXPECT_THAT(xml, HasSubstr(">1 &lt; 2 &amp; &quot;so&quot;</failure>"));
}

TEST(UnfinishedJunit, IsRed) {
  const std::string xml = written({unfinished_junit("short")});
  EXPECT_THAT(xml, HasSubstr(R"(tests="1" failures="0" errors="1")"));
  EXPECT_THAT(xml, HasSubstr(R"(<error message="incomplete run"/>)"));
}

TEST(SaveJunit, AFolderThatIsNotThereIsAnInputError) {
  EXPECT_THROW(save_junit("/nowhere/at/all/junit.xml", {}), InputError);
}

TEST(LoadJunit, ReadsBackWhatWasSaved) {
  const test::TemporaryFolder folder;
  JunitCase failed = make_case("pose.ate_rmse_m <= 0.1", JunitResult::kFailure, "is 0.2, \"expected\" <= 0.1 & less");
  failed.details = "at 12 s";
  save_junit(folder / "junit.xml", {{.name = "a<b",
                                     .time_s = 3.0,
                                     .properties = {{"seed", "7"}, {"version", "0.1.0"}},
                                     .cases = {make_case("run", JunitResult::kPassed), failed,
                                               make_case("fault", JunitResult::kSkipped, "NOT EXECUTED")}}});
  const std::vector<JunitSuite> suites = load_junit(folder / "junit.xml");
  ASSERT_EQ(suites.size(), 1u);
  EXPECT_EQ(suites[0].name, "a<b");
  EXPECT_EQ(suites[0].properties,
            (std::vector<std::pair<std::string, std::string>>{{"seed", "7"}, {"version", "0.1.0"}}));
  ASSERT_EQ(suites[0].cases.size(), 3u);
  EXPECT_EQ(suites[0].cases[0].result, JunitResult::kPassed);
  EXPECT_EQ(suites[0].cases[0].time_s, 1.5);
  EXPECT_EQ(suites[0].cases[1].result, JunitResult::kFailure);
  EXPECT_EQ(suites[0].cases[1].message, failed.message);
  EXPECT_EQ(suites[0].cases[1].details, "at 12 s");
  EXPECT_EQ(suites[0].cases[2].result, JunitResult::kSkipped);
}

TEST(LoadJunit, AnUnfinishedRunIsAnError) {
  const test::TemporaryFolder folder;
  save_junit(folder / "junit.xml", {unfinished_junit("short")});
  EXPECT_EQ(load_junit(folder / "junit.xml").at(0).cases.at(0).result, JunitResult::kError);
}

TEST(LoadJunit, RefusesWhatIsNotJunitAndNamesTheFile) {
  const test::TemporaryFile broken("junit.xml", "<testsuites>\n<testsuite"), other("junit.xml", "<html/>"),
      empty("junit.xml", "");
  for (const auto* file : {&broken, &other, &empty}) {
    EXPECT_THAT([&] { load_junit(file->path()); }, ::testing::ThrowsMessage<InputError>(HasSubstr("junit.xml")));
  }
}

}  // namespace
}  // namespace patrol::io::junit_test
