#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "app/common/text_style.h"
#include "app/run/run_verdict.h"

namespace patrol::app {

/// Number of lines of a summary, at most.
inline constexpr std::size_t kMaxSummaryLines = 25;

/// Summary of a run for a terminal in at most `kMaxSummaryLines` lines: status, expectations with the missed ones
/// first, at most ten key figures, events that were not triggered, and the place of the other metrics. `title` names
/// the scenario and the seed.
std::string run_summary(const std::string& title, const RunVerdict& verdict, const std::filesystem::path& directory,
                        TextStyle style);

/// Every metric with its expectation, the table of the goals, the events, and the run directory: `--all`.
std::string run_details(const std::string& title, const RunVerdict& verdict, const std::filesystem::path& directory,
                        TextStyle style);

/// Verdict of a run and its directory, for `--json`.
io::Metrics run_json(const RunVerdict& verdict, const std::filesystem::path& directory);

}  // namespace patrol::app
