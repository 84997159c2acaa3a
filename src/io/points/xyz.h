#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/sensors/registry.h"

/// Point clouds as text: a point per line. There is no standard; these are the forms that CloudCompare and the software
/// of terrestrial scanners write (XYZ, ASC, PTS, CSV).
namespace patrol::io {

struct PointShift;  // io/points/point_collector.h

/// Reads x, y, z and intensity (0 if missing) from lines of equally many numbers, separated by blanks, commas or
/// semicolons. If the first line names columns, x, y, z and intensity are those of these names. Otherwise the first
/// three numbers are x, y and z, and the fourth of four or seven is the intensity. A first line with one number is the
/// count of PTS. Other lines that begin with # or // are ignored. Sets `columns` to a sentence about the columns,
/// if no line names them. Points that are not finite are left out and counted in `shift`. Throws InputError for an
/// invalid file, also for numbers with decimal commas.
std::vector<ScannerPoint> load_shifted_xyz(const std::filesystem::path& file, PointShift& shift, std::string& columns);

}  // namespace patrol::io
