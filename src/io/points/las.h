#pragma once

#include <filesystem>
#include <vector>

#include "core/sensors/registry.h"

/// Point clouds of surveys in LAS (ASPRS, LAS Specification 1.4-R15).
namespace patrol::io {

struct PointShift;  // io/points/point_collector.h

/// Reads positions, in the units of the file, and intensities of the versions 1.0 to 1.4, point formats 0 to 10. Leaves
/// out points that are marked as withheld or classified as noise (classes 7 and 18), and counts them in `shift`. Throws
/// InputError for an invalid file, also for LAZ, which is compressed.
std::vector<ScannerPoint> load_shifted_las(const std::filesystem::path& file, PointShift& shift);

}  // namespace patrol::io
