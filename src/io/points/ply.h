#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/sensors/registry.h"

/// Point clouds in PLY, the Stanford triangle format (G. Turk, 1994).
namespace patrol::io {

struct PointShift;  // io/points/point_collector.h

/// Writes binary little-endian PLY: x, y, z in meters and intensity, as floats. `comment` is one line.
void save_ply(const std::filesystem::path& file, const std::vector<ScannerPoint>& points,
              const std::string& comment = "");

/// Reads the properties x, y, z and intensity (0 if missing), of any type, of the first element, `vertex`; ascii or
/// binary little-endian. Data after the vertices are ignored. Throws InputError for an invalid file. Memory is bounded
/// by a small multiple of the file size.
std::vector<ScannerPoint> load_ply(const std::filesystem::path& file);

/// Reads points as `load_ply`, shifted to an origin, and leaves out points that are not finite.
std::vector<ScannerPoint> load_shifted_ply(const std::filesystem::path& file, PointShift& shift);

}  // namespace patrol::io
