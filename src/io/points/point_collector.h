#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "core/sensors/registry.h"

namespace patrol::io {

/// Shift of the points of a file to an origin, in double precision.
struct PointShift {
  std::optional<Eigen::Vector3d> origin;  ///< none: set by the first finite point (io/points/point_reading.h)
  std::size_t num_dropped = 0;            ///< number of points that are left out
  double unit_m = 1.0;                    ///< meters per unit of the file
  bool is_single_precision = false;       ///< the file has floats of 32 bits
};

/// Returns zero for a position within 10 km of zero on each axis, else the position rounded to 100 m; both in units of
/// the file.
Eigen::Vector3d origin_of(const Eigen::Vector3d& first, double unit_m = 1.0);

/// List of points with floats of 32 bits, from numbers in double precision.
class PointCollector {
 public:
  /// `shift` may be null, and must outlive the collector.
  explicit PointCollector(PointShift* shift) : shift_(shift) {}

  void reserve(std::size_t num_points) { points_.reserve(num_points); }
  /// Appends a point: x, y, z and intensity. With a shift, leaves out a point that is not finite; without one, returns
  /// false for it. Returns false for numbers of 1e30 or more.
  bool add(std::array<double, 4> numbers);
  std::vector<ScannerPoint> take() { return std::move(points_); }

 private:
  PointShift* shift_;
  std::vector<ScannerPoint> points_;
};

}  // namespace patrol::io
