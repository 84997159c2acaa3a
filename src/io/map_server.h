#pragma once

#include <filesystem>

#include "core/grid.h"

namespace patrol::io {

/// map_server's pair of files: `file` is the YAML, the PGM image lies beside it under the same name. Trinary: occupied 0, free 254,
/// unknown 205; the origin is the lower-left corner. Other people's may be PGM in figures too, negated, with other thresholds, but
/// not turned, nor of another mode. Throws InputError with the file, the line and the key.
void save_map(const std::filesystem::path& file, const OccupancyGrid& map);
OccupancyGrid load_map(const std::filesystem::path& file);

}  // namespace patrol::io
