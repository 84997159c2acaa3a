#include "io/junit.h"

#include <algorithm>

#include <fmt/format.h>

#include "io/settings_yaml.h"

namespace patrol::io {
namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += c;
    }
  }
  return out;
}

std::size_t count(const JunitSuite& suite, JunitCase::Verdict verdict) {
  return static_cast<std::size_t>(
      std::count_if(suite.cases.begin(), suite.cases.end(), [&](const JunitCase& c) { return c.verdict == verdict; }));
}

}  // namespace

void save_junit(const std::filesystem::path& file, const JunitSuite& suite) {
  using Verdict = JunitCase::Verdict;
  const std::string counts = fmt::format(R"(tests="{}" failures="{}" errors="{}" skipped="{}" time="{:.3f}")", suite.cases.size(),
                                         count(suite, Verdict::kFailed), count(suite, Verdict::kError),
                                         count(suite, Verdict::kSkipped), suite.time_s);
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites " + counts + ">\n";
  xml += fmt::format("  <testsuite name=\"{}\" {}>\n    <properties>\n", escaped(suite.name), counts);
  for (const auto& [name, value] : suite.properties) {
    xml += fmt::format("      <property name=\"{}\" value=\"{}\"/>\n", escaped(name), escaped(value));
  }
  xml += "    </properties>\n";
  for (const JunitCase& c : suite.cases) {
    xml += fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"0\"", escaped(suite.name), escaped(c.name));
    const char* element = c.verdict == Verdict::kFailed ? "failure" : c.verdict == Verdict::kError ? "error" : "skipped";
    xml += c.verdict == Verdict::kPassed ? "/>\n" : fmt::format("><{} message=\"{}\"/></testcase>\n", element, escaped(c.message));
  }
  save_text(file, xml + "  </testsuite>\n</testsuites>\n");
}

}  // namespace patrol::io
