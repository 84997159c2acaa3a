#pragma once

#include <filesystem>

#include "core/grid.h"

namespace patrol::io {

/// Write and read a map as the file pair of the ROS map_server. `file` is the YAML file; the PGM image has the same
/// name and is in the same folder. Trinary mode: occupied 0, free 254, unknown 205; the origin is the lower-left
/// corner. Also readable: ASCII PGM, PGM with another largest gray value, PNG, negated images, other thresholds, modes
/// scale and raw, with the rules of nav2_map_server: the value of a pixel is the mean of its color channels. Mode
/// trinary averages alpha with them, mode scale takes pixels that are not opaque as unknown. Rotated maps are rejected.
/// Throw InputError with file, line and key.
void save_map(const std::filesystem::path& file, const OccupancyGrid& map);
OccupancyGrid load_map(const std::filesystem::path& file);
/// Returns the image named in the YAML file of a map. Throws InputError with file, line and key.
std::filesystem::path map_image(const std::filesystem::path& file);

/// Write and read the errors of the occupied cells of a map, on the grid of the map. The PGM holds millimeters: 254
/// stands for this value and more, 255 for cells that are not occupied (NaN in memory). `load_map_errors` throws
/// InputError if the image has another size than the map.
void save_map_errors(const std::filesystem::path& file_pgm, const Grid<float>& errors_m);
Grid<float> load_map_errors(const std::filesystem::path& file_pgm, const GridGeometry& geometry);

}  // namespace patrol::io
