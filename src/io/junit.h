#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace patrol::io {

/// One check of a run.
struct JunitCase {
  enum class Verdict { kPassed, kFailed, kError, kSkipped };
  std::string name;
  Verdict verdict = Verdict::kPassed;
  std::string message;  ///< why it failed or was skipped
};

struct JunitSuite {
  std::string name;
  double time_s = 0.0;
  std::vector<std::pair<std::string, std::string>> properties;  ///< e.g. seed, version
  std::vector<JunitCase> cases;
};

/// Writes JUnit XML, as CI servers read it; the file appears whole or not at all.
void save_junit(const std::filesystem::path& file, const JunitSuite& suite);

}  // namespace patrol::io
