#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "importer/site/points/panorama.h"

namespace patrol::importer {

/// Multiplies points by a matrix.
void transform(std::vector<ScannerPoint>& points, const Eigen::Matrix3d& A);

/// Scans as images of ranges.
struct SortedScans {
  std::vector<Panorama> panoramas;  ///< in site
  float max_intensity = 0.0f;
  std::string problem = {};  ///< sentence about a scan whose points were not seen from its pose; empty: there is none
};

/// Sorts scans into panoramas, up to the first one with a problem. `R_site_file`: rotation to z up; `unit_m`: meters
/// per unit of the file. Consumes the points. Throws InputError for a scan with too few points.
SortedScans sort_scans(std::vector<io::StationScan>& scans, const Eigen::Matrix3d& R_site_file, double unit_m,
                       const std::function<void(std::size_t)>& on_scan);

}  // namespace patrol::importer
