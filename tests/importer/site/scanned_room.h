#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/geometry/angles.h"
#include "core/random.h"
#include "importer/site/imported_site.h"
#include "io/points/point_reading.h"

namespace patrol::importer {

/// Room of 8 x 6 x 3 m around the origin, floor at height 0, with boxes in it.
struct ScannedRoom {
  Eigen::AlignedBox3d walls{Eigen::Vector3d(-4.0, -3.0, 0.0), Eigen::Vector3d(4.0, 3.0, 3.0)};
  std::vector<Eigen::AlignedBox3d> objects;

  /// Returns the range along a unit direction from a point in the room.
  double range_m(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
    const Eigen::Array3d to_low = (walls.min() - origin).array() / direction.array(),
                         to_high = (walls.max() - origin).array() / direction.array();
    double best = to_low.max(to_high).minCoeff();
    for (const Eigen::AlignedBox3d& box : objects) {
      const Eigen::Array3d a = (box.min() - origin).array() / direction.array(),
                           b = (box.max() - origin).array() / direction.array();
      const double enter = a.min(b).maxCoeff(), leave = a.max(b).minCoeff();
      if (enter < leave && enter > 0.0) best = std::min(best, enter);
    }
    return best;
  }

  /// Returns a scan with a noise of 0.5 mm, elevations from -60 to 90 degrees, in the order of columns.
  io::StationScan scan(const std::string& station, const Eigen::Vector3d& origin, double step_deg = 0.6) const {
    io::StationScan scan{.station = station, .T_map_scanner = {origin, Eigen::Quaterniond::Identity()}, .points = {}};
    const RandomStream noise(7, station);
    const int columns = static_cast<int>(std::lround(360.0 / step_deg)), rows = static_cast<int>(150.0 / step_deg);
    for (int col = 0; col < columns; ++col) {
      for (int row = 0; row < rows; ++row) {
        // Off the axes, so that no component of a direction is zero.
        const double azimuth = to_rad((col + 0.37) * step_deg), elevation = to_rad(-60.0 + (row + 0.21) * step_deg);
        const Eigen::Vector3d d(std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                                std::sin(elevation));
        const double range = range_m(origin, d) + 0.0005 * noise.normal(static_cast<std::uint64_t>(col * rows + row));
        const Eigen::Vector3f p = (origin + range * d).cast<float>();
        scan.points.push_back({p.x(), p.y(), p.z(), 120.0f});
      }
    }
    return scan;
  }
};

/// Triangle of a site with its material.
struct SiteTriangle {
  Eigen::Vector3d center, area_normal;
  bool is_filled_in = false;
  double area_m2() const { return 0.5 * area_normal.norm(); }
};

inline std::vector<SiteTriangle> triangles_of(const ImportedSite& site) {
  std::vector<SiteTriangle> triangles;
  for (const SiteShape& shape : site.shapes) {
    for (const auto& [i, j, k] : shape.mesh.triangles) {
      const Eigen::Vector3d &a = shape.mesh.vertices_m[static_cast<std::size_t>(i)],
                            &b = shape.mesh.vertices_m[static_cast<std::size_t>(j)],
                            &c = shape.mesh.vertices_m[static_cast<std::size_t>(k)];
      triangles.push_back({.center = (a + b + c) / 3.0,
                           .area_normal = (b - a).cross(c - a),
                           .is_filled_in = shape.material == "filled_in"});
    }
  }
  return triangles;
}

/// Returns the area of the triangles with their center in a box.
inline double area_in(const ImportedSite& site, const Eigen::AlignedBox3d& box, bool is_filled_in) {
  double area_m2 = 0.0;
  for (const SiteTriangle& triangle : triangles_of(site)) {
    if (triangle.is_filled_in == is_filled_in && box.contains(triangle.center)) area_m2 += triangle.area_m2();
  }
  return area_m2;
}

inline std::string assumption(const ImportedSite& site, const std::string& subject) {
  for (const Assumption& row : site.assumptions) {
    if (row.subject == subject) return row.text;
  }
  return "";
}

}  // namespace patrol::importer
