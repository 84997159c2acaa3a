#pragma once

#include <filesystem>
#include <string>

#include "io/files/table.h"

namespace patrol::io {

/// Formats a table as CSV (RFC 4180) with a header line. Numbers have the fewest digits that read back identically.
std::string to_csv(const Table& table);
/// Writes a table as CSV, atomically.
void save_csv(const std::filesystem::path& file, const Table& table);

}  // namespace patrol::io
