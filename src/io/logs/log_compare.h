#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/time.h"

namespace patrol::io {

/// First difference between two logs.
struct LogDifference {
  std::string topic;  ///< empty if the difference is not in a message
  Time log_time{};
  std::string what;  ///< phrase such as "ranges[417] is 3.26, was 3.25"
};

/// Returns the first message of `again` that is not byte-identical to that of `log`; nullopt if the files are equal.
std::optional<LogDifference> first_difference(const std::filesystem::path& log, const std::filesystem::path& rerun);

/// Formats a difference: "/scan at 12.300000000 s: ranges[417] is 3.26, was 3.25".
std::string describe(const LogDifference& difference);

}  // namespace patrol::io
