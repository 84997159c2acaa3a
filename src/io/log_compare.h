#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/time.h"

namespace patrol::io {

/// Where two logs part.
struct LogDifference {
  std::string topic;
  Time log_time{};
  std::string what;  ///< a phrase: "byte 132 of the message is 0x3f, was 0x40"
};

/// The first message at which `again` is not byte for byte what `log` is; none if the files are equal.
std::optional<LogDifference> first_difference(const std::filesystem::path& log, const std::filesystem::path& again);

}  // namespace patrol::io
