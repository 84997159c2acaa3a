#pragma once

#include <filesystem>

#include "core/grid.h"

namespace patrol::io {

/// map_server's pair of files: `file` is the YAML, the PGM image lies beside it under the same name. Trinary: occupied 0, free 254,
/// unknown 205; the origin is the lower-left corner. Other people's may be PGM in figures too, negated, with other thresholds, but
/// not turned, nor of another mode. Throws InputError with the file, the line and the key.
void save_map(const std::filesystem::path& file, const OccupancyGrid& map);
OccupancyGrid load_map(const std::filesystem::path& file);
/// The image that a map's YAML names. Throws likewise.
std::filesystem::path map_image(const std::filesystem::path& file);

/// Errors of a map's occupied cells, on its own cells: a PGM, in millimetres, 254 for that and more, 255 where nothing is occupied (NaN in
/// memory). Throws InputError when the image is not of the map's size.
void save_map_errors(const std::filesystem::path& file_pgm, const Grid<float>& errors_m);
Grid<float> load_map_errors(const std::filesystem::path& file_pgm, const GridGeometry& geometry);

}  // namespace patrol::io
