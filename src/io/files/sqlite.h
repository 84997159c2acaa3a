#pragma once

#include <filesystem>
#include <vector>

#include "io/files/table.h"

namespace patrol::io {

/// Writes a new SQLite database with these tables, atomically. The same tables produce the same bytes with the same
/// release of SQLite. Throws InputError if the file cannot be written, OutputError if the disk is full or fails.
void save_sqlite(const std::filesystem::path& file, const std::vector<Table>& tables);

}  // namespace patrol::io
