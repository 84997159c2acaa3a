#include "io/files/junit.h"

#include <algorithm>

#include <fmt/format.h>
#include <tinyxml2.h>

#include "core/error.h"
#include "io/files/atomic_file.h"
#include "io/files/markup_text.h"

namespace patrol::io {
namespace {

auto count(const std::vector<JunitCase>& cases, JunitResult result) {
  return std::count_if(cases.begin(), cases.end(), [&](const JunitCase& c) { return c.result == result; });
}

/// Formats the counts of a JUnit suite or of all suites.
std::string tally(const std::vector<JunitCase>& cases, double time_s) {
  return fmt::format(R"(tests="{}" failures="{}" errors="{}" skipped="{}" time="{:.3f}")", cases.size(),
                     count(cases, JunitResult::kFailure), count(cases, JunitResult::kError),
                     count(cases, JunitResult::kSkipped), time_s);
}

std::string outcome(const JunitCase& test) {
  const char* element = test.result == JunitResult::kFailure ? "failure"
                        : test.result == JunitResult::kError ? "error"
                                                             : "skipped";
  if (test.details.empty()) return fmt::format("      <{} message=\"{}\"/>\n", element, escaped_markup(test.message));
  return fmt::format("      <{0} message=\"{1}\">{2}</{0}>\n", element, escaped_markup(test.message),
                     escaped_markup(test.details));
}

std::string to_xml(const JunitCase& test) {
  const std::string head = fmt::format(R"(    <testcase classname="{}" name="{}" time="{:.3f}")",
                                       escaped_markup(test.class_name), escaped_markup(test.name), test.time_s);
  if (test.result == JunitResult::kPassed) return head + "/>\n";
  return head + ">\n" + outcome(test) + "    </testcase>\n";
}

std::string to_xml(const JunitSuite& suite) {
  std::string xml =
      fmt::format("  <testsuite name=\"{}\" {}>\n", escaped_markup(suite.name), tally(suite.cases, suite.time_s));
  if (!suite.properties.empty()) {
    xml += "    <properties>\n";
    for (const auto& [name, value] : suite.properties) {
      xml += fmt::format("      <property name=\"{}\" value=\"{}\"/>\n", escaped_markup(name), escaped_markup(value));
    }
    xml += "    </properties>\n";
  }
  for (const JunitCase& test : suite.cases) xml += to_xml(test);
  return xml + "  </testsuite>\n";
}

std::string text_of(const tinyxml2::XMLElement& element, const char* attribute) {
  const char* text = element.Attribute(attribute);
  return text == nullptr ? "" : text;
}

JunitCase case_of(const tinyxml2::XMLElement& element) {
  JunitCase test{.class_name = text_of(element, "classname"),
                 .name = text_of(element, "name"),
                 .time_s = element.DoubleAttribute("time"),
                 .result = JunitResult::kPassed,
                 .message = "",
                 .details = ""};
  for (const auto& [name, result] : {std::pair("failure", JunitResult::kFailure),
                                     {"error", JunitResult::kError},
                                     {"skipped", JunitResult::kSkipped}}) {
    const tinyxml2::XMLElement* outcome = element.FirstChildElement(name);
    if (outcome == nullptr) continue;
    test.result = result;
    test.message = text_of(*outcome, "message");
    test.details = outcome->GetText() == nullptr ? "" : outcome->GetText();
  }
  return test;
}

JunitSuite suite_of(const tinyxml2::XMLElement& element) {
  JunitSuite suite{
      .name = text_of(element, "name"), .time_s = element.DoubleAttribute("time"), .properties = {}, .cases = {}};
  if (const tinyxml2::XMLElement* list = element.FirstChildElement("properties")) {
    for (const auto* property = list->FirstChildElement("property"); property != nullptr;
         property = property->NextSiblingElement("property")) {
      suite.properties.emplace_back(text_of(*property, "name"), text_of(*property, "value"));
    }
  }
  for (const auto* test = element.FirstChildElement("testcase"); test != nullptr;
       test = test->NextSiblingElement("testcase")) {
    suite.cases.push_back(case_of(*test));
  }
  return suite;
}

}  // namespace

std::vector<JunitSuite> load_junit(const std::filesystem::path& file) {
  const std::string text = load_text(file);
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw input_error(file.string(), document.ErrorLineNum(), "is not XML");
  }
  const tinyxml2::XMLElement* root = document.FirstChildElement("testsuites");
  if (root == nullptr) throw InputError(file.string() + ": is not JUnit XML: it has no testsuites");
  std::vector<JunitSuite> suites;
  for (const auto* suite = root->FirstChildElement("testsuite"); suite != nullptr;
       suite = suite->NextSiblingElement("testsuite")) {
    suites.push_back(suite_of(*suite));
  }
  return suites;
}

void save_junit(const std::filesystem::path& file, const std::vector<JunitSuite>& suites) {
  std::vector<JunitCase> all;
  double time_s = 0.0;
  std::string body;
  for (const JunitSuite& suite : suites) {
    all.insert(all.end(), suite.cases.begin(), suite.cases.end());
    time_s += suite.time_s;
    body += to_xml(suite);
  }
  save_text(file, fmt::format(
                      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"patrol\" {}>\n{}</testsuites>\n",
                      tally(all, time_s), body));
}

JunitSuite unfinished_junit(const std::string& suite) {
  return {.name = suite,
          .time_s = 0.0,
          .properties = {},
          .cases = {{.class_name = suite,
                     .name = "run",
                     .time_s = 0.0,
                     .result = JunitResult::kError,
                     .message = "incomplete run",
                     .details = ""}}};
}

}  // namespace patrol::io
