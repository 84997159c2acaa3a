#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace patrol::io {

enum class JunitResult { kPassed, kFailure, kError, kSkipped };

struct JunitCase {
  std::string class_name;
  std::string name;
  double time_s = 0.0;
  JunitResult result = JunitResult::kPassed;
  std::string message;  ///< why it did not pass: one line
  std::string details;  ///< more of it, if there is more
};

/// One run's report. Properties are what a reader needs to run it again: scenario, seed, version.
struct JunitSuite {
  std::string name;
  double time_s = 0.0;
  std::vector<std::pair<std::string, std::string>> properties;
  std::vector<JunitCase> cases;
};

/// Writes JUnit XML as the common CI servers read it (testsuites, testsuite, testcase), whole or not at all.
void save_junit(const std::filesystem::path& file, const std::vector<JunitSuite>& suites);

/// What `save_junit` wrote. Throws InputError when it is not that.
std::vector<JunitSuite> load_junit(const std::filesystem::path& file);

/// The report that stands there from before the run until its end: red, so that a killed run never looks green.
JunitSuite unfinished_junit(const std::string& suite);

}  // namespace patrol::io
