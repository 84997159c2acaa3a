#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/time.h"

namespace patrol::io {

/// Where two logs part.
struct LogDifference {
  std::string topic;  ///< empty if it is not about a message
  Time log_time{};
  std::string what;   ///< a phrase: "ranges[417] is 3.26, was 3.25"
};

/// The first message at which `again` is not byte for byte what `log` is; none if the files are equal.
std::optional<LogDifference> first_difference(const std::filesystem::path& log, const std::filesystem::path& again);

/// "/scan at 12.300000000 s: ranges[417] is 3.26, was 3.25".
std::string describe(const LogDifference& difference);

}  // namespace patrol::io
