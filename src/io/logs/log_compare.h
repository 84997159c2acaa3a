#pragma once

#include <filesystem>
#include <functional>
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

/// Returns the first message of `rerun` that is not byte-identical to that of `log`; nullopt if the files are equal.
std::optional<LogDifference> first_difference(const std::filesystem::path& log, const std::filesystem::path& rerun);

/// Compares only the messages on the topics of which `is_compared` is true; nullopt if they are equal.
std::optional<LogDifference> first_difference(const std::filesystem::path& log, const std::filesystem::path& rerun,
                                              const std::function<bool(const std::string& topic)>& is_compared);

/// Formats a difference: "/scan at 12.300000000 s: ranges[417] is 3.26, was 3.25".
std::string describe(const LogDifference& difference);

}  // namespace patrol::io
