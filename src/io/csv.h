#pragma once

#include <filesystem>
#include <string>

#include "io/table.h"

namespace patrol::io {

/// RFC 4180 with a header line, numbers in the fewest digits that read back as the same; whole or not at all.
std::string to_csv(const Table& table);
void save_csv(const std::filesystem::path& file, const Table& table);

}  // namespace patrol::io
