#pragma once

#include <cstddef>
#include <string>

namespace patrol::io {

/// Checks a JSON text in one pass without storing it. Throws InputError for invalid JSON (with file and line), and for
/// numbers that overflow, duplicate keys, deep nesting, and lists of more than `max_entries` entries (with file and
/// JSON path). The check of a list ends at its first excess entry.
void check_json(const std::string& file, const std::string& text, std::size_t max_entries);

}  // namespace patrol::io
