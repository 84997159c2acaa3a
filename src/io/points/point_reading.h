#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/sensors/registry.h"
#include "io/points/station_scans.h"

/// Reading of point clouds of other instruments: coordinates of any size, and points without a return.
namespace patrol::io {

/// Points relative to an origin. Coordinates of millions of meters (UTM) have a resolution of decimeters as floats.
struct RelativePoints {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< in the frame of the file
  std::vector<ScannerPoint> points;                  ///< position minus `origin`; all values are finite
  std::size_t num_dropped = 0;  ///< number of points of the file that are not finite, noise or withheld
  std::string columns = {};     ///< sentence about the columns of a text that does not name them; else empty
  double step = 0.0;  ///< distance of neighboring coordinates at `origin`, if the file has floats of 32 bits; else 0
};

/// Reads a file by its extension (PLY, PCD, LAS or text) and drops points that are not finite, noise or withheld.
/// `origin`: in the frame of the file; `unit_m`: meters per unit. Without an origin, it is zero if the first finite
/// point is within 10 km of zero on each axis, else that point rounded to 100 m. Throws InputError for an invalid file
/// or another extension.
RelativePoints load_points(const std::filesystem::path& file, const std::optional<Eigen::Vector3d>& origin = {},
                           double unit_m = 1.0);

/// Scans of a folder relative to one origin.
struct RelativeScans {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< in the frame of the folder, by the rule of `load_points`
  std::vector<StationScan> scans;                    ///< poses and points minus `origin`
  std::size_t num_dropped = 0;                       ///< number of points that are not finite
};

/// Reads stored scans as `load_station_scans`, relative to an origin by the first pose.
RelativeScans load_relative_scans(const std::filesystem::path& folder, double unit_m = 1.0);

/// Returns whether a PLY file has an element `face` with at least one face. Throws InputError for an invalid header.
bool has_faces(const std::filesystem::path& ply_file);

}  // namespace patrol::io
