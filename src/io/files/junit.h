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
  std::string message;  ///< reason of the result if not passed; one line
  std::string details;  ///< further details; may be empty
};

/// JUnit report of one run. The properties identify the run for a repetition: scenario, seed, version.
struct JunitSuite {
  std::string name;
  double time_s = 0.0;
  std::vector<std::pair<std::string, std::string>> properties;
  std::vector<JunitCase> cases;
};

/// Writes JUnit XML for common CI servers (testsuites, testsuite, testcase), atomically.
void save_junit(const std::filesystem::path& file, const std::vector<JunitSuite>& suites);

/// Reads a file of `save_junit`. Throws InputError if it has another format.
std::vector<JunitSuite> load_junit(const std::filesystem::path& file);

/// Returns the failing report written before a run. It is replaced at the end of the run, so that a killed run never
/// passes.
JunitSuite unfinished_junit(const std::string& suite);

}  // namespace patrol::io
