#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "core/time.h"

namespace patrol::io {

/// One message as it stands in the file.
struct McapMessage {
  const std::string& topic;
  const std::string& type;
  Time log_time;
  std::string_view cdr;
};

/// Calls `handle` for every message in the file's order. Returns whether the file is whole: one that was cut off (by a crash)
/// is read up to the cut. Throws InputError, naming file and byte, when it is no MCAP file or damaged otherwise.
bool read_mcap(const std::filesystem::path& path, const std::function<void(const McapMessage&)>& handle);

}  // namespace patrol::io
