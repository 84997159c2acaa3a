#pragma once

#include <cstddef>
#include <string>

namespace patrol::io {

/// Checks a JSON text in one pass without storing it. Throws InputError with file, line and JSON path for invalid JSON,
/// numbers that overflow, duplicate keys, and lists with more than `max_entries` entries. The check of a list ends at
/// its first excess entry.
void check_json(const std::string& file, const std::string& text, std::size_t max_entries);

}  // namespace patrol::io
