#pragma once

#include <filesystem>
#include <vector>

#include "io/table.h"

namespace patrol::io {

/// A new SQLite database of these tables, whole or not at all. The same tables give the same bytes (with one release of
/// SQLite). Throws InputError when the place cannot be written to.
void save_sqlite(const std::filesystem::path& file, const std::vector<Table>& tables);

}  // namespace patrol::io
