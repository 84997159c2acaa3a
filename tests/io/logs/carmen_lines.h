#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/logs/carmen_log.h"
#include "tests/support/temporary_file.h"

/// Lines of synthetic CARMEN logs for the tests, and what is read from them.
namespace patrol::io::carmen_lines {

inline std::string repeated(const std::string& word, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += " " + word;
  return text;
}

/// "FLASER 4 1 2 3 4 <laser> <robot> <t> host 0"
inline std::string flaser(const std::string& stamp, const std::string& laser = "1 2 0.5",
                          const std::string& robot = "1 2 0.5", const std::string& ranges = "4 1 2 3 4") {
  return "FLASER " + ranges + " " + laser + " " + robot + " " + stamp + " host 0.5\n";
}

inline std::string robotlaser(const std::string& geometry, int num_beams, const std::string& poses = "1 2 0.5 1 2 0.5",
                              const std::string& remissions = "0") {
  return fmt::format("ROBOTLASER1 {} {}{} {} {} 0.1 0.2 0.3 0.4 0.5 10.25 host 3\n", geometry, num_beams,
                     repeated("1.5", num_beams), remissions, poses);
}

struct Read {
  std::vector<RecordedScan> scans;
  ScanLogSummary summary;
};

inline Read read(const std::string& text, const ScanLogOptions& options = {}) {
  const test::TemporaryFile file("a.log", text);
  const std::unique_ptr<ScanLog> log = open_scan_log(file.path(), options);
  Read result;
  while (std::optional<RecordedScan> scan = log->next()) result.scans.push_back(std::move(*scan));
  EXPECT_EQ(log->progress(), 1.0);
  result.summary = log->summary();
  EXPECT_EQ(result.summary.num_scans, result.scans.size());
  return result;
}

inline RecordedScan read_one(const std::string& text, const ScanLogOptions& options = {}) {
  const Read result = read(text, options);
  EXPECT_EQ(result.scans.size(), 1U);
  return result.scans.empty() ? RecordedScan{} : result.scans.front();
}

inline std::string complaint_about(const std::string& text, const ScanLogOptions& options = {}) {
  const test::TemporaryFile file("a.log", text);
  try {
    CarmenLog log(file.path(), options);
    while (log.next()) {}
  } catch (const InputError& error) {
    const std::string what = error.what();
    return what.substr(what.find("a.log"));
  }
  return "";
}

}  // namespace patrol::io::carmen_lines
