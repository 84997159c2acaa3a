#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/sensors/registry.h"

/// Point clouds in PLY, the Stanford triangle format (G. Turk, 1994).
namespace patrol::io {

/// Binary, little-endian: x, y, z in metres and intensity, as floats. `comment` is one line.
void save_ply(const std::filesystem::path& file, const std::vector<ScannerPoint>& points, const std::string& comment = "");

/// Of the first element, `vertex`, the properties x, y, z and intensity (0 where there is none), of any type; ascii or binary
/// little-endian. What follows the vertices is not read. Throws InputError that says what is wrong; takes no more memory than a
/// few times the file's size.
std::vector<ScannerPoint> load_ply(const std::filesystem::path& file);

}  // namespace patrol::io
