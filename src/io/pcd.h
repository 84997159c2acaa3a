#pragma once

#include <filesystem>
#include <vector>

#include "core/sensors/registry.h"

/// Point clouds in PCD, the Point Cloud Library's format, version 0.7.
namespace patrol::io {

/// Binary: x, y, z in metres and intensity, as floats; one row, the viewpoint at the origin.
void save_pcd(const std::filesystem::path& file, const std::vector<ScannerPoint>& points);

/// The fields x, y, z and intensity (0 where there is none), of any type; DATA ascii or binary. Points stay in the file's own frame,
/// whatever its VIEWPOINT. Throws InputError that says what is wrong; takes no more memory than a few times the file's size.
std::vector<ScannerPoint> load_pcd(const std::filesystem::path& file);

}  // namespace patrol::io
