#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/frames.h"
#include "io/points/station_scans.h"

namespace patrol::importer {

/// State of a pixel of a panorama, as bits.
enum PixelState : std::uint8_t {
  kPixelRight = 1u << 0,     ///< the surface continues to the next column
  kPixelUp = 1u << 1,        ///< the surface continues to the next row
  kPixelOutlier = 1u << 2,   ///< lone return between surfaces
  kPixelMoving = 1u << 3,    ///< return of an object that other scans look through
  kPixelCovered = 1u << 4,   ///< another scan measured the same surface with closer beams
  kPixelObserved = 1u << 5,  ///< another scan measured the same surface
  kPixelBlocked = 1u << 6,   ///< no return, where a surface may be closer than the minimum range (near_gaps.h)
};

/// Pixel of a panorama.
struct Pixel {
  int col = 0;
  int row = 0;
};

/// Panoramic scan as an image of ranges. Columns are equally spaced in azimuth and cover the circle, rows are equally
/// spaced in elevation, both with the same step. Directions are in the upright frame of the scanner.
class Panorama {
 public:
  /// Sorts the points of a scan into pixels. The step is a whole number of columns per turn: the one with which the
  /// elevations are on a grid, near the typical angle between consecutive points, or between all points if they are not
  /// in the order of columns or rows. A pixel with several points keeps the one nearest to its center. Single empty
  /// pixels between neighbors on one surface are interpolated. Throws InputError for fewer than 16 points.
  explicit Panorama(const io::StationScan& scan);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  double step_rad() const { return step_rad_; }
  const Eigen::Vector3d& origin() const { return T_site_scanner_.position; }
  /// Returns the largest range of a return.
  double max_range_m() const { return max_range_m_; }
  /// Returns the part of the points that share a pixel with a point at another range: near 0 if the scanner was at the
  /// pose of the scan, since a beam has one return.
  double hidden_part() const { return hidden_part_; }

  /// Returns the range, m; 0 if the pixel has no return.
  float range_m(Pixel pixel) const { return range_m_[index(pixel)]; }
  float intensity(Pixel pixel) const { return intensity_[index(pixel)]; }
  std::uint8_t& state(Pixel pixel) { return state_[index(pixel)]; }
  std::uint8_t state(Pixel pixel) const { return state_[index(pixel)]; }
  bool has(Pixel pixel, PixelState state) const { return (state_[index(pixel)] & state) != 0; }
  /// Returns whether the pixel has a return that is neither an outlier nor of a moving object.
  bool is_usable(Pixel pixel) const {
    return range_m_[index(pixel)] > 0.0f && (state_[index(pixel)] & (kPixelOutlier | kPixelMoving)) == 0;
  }

  /// Returns the unit direction of a position in pixels, in site. Pixel (c, r) has its center at (c, r).
  Eigen::Vector3d direction(double col, double row) const;
  /// Returns the unit direction of the center of a pixel, in site.
  Eigen::Vector3d direction(Pixel pixel) const;
  /// Returns the point of a pixel with a return, in site.
  Eigen::Vector3d point(Pixel pixel) const { return origin() + double{range_m(pixel)} * direction(pixel); }
  /// Returns the pixel of a point in site; its row may be outside the panorama.
  Pixel nearest_pixel(const Eigen::Vector3d& p_site) const;
  /// Returns the pixel of a point in site; none outside the rows.
  std::optional<Pixel> pixel_of(const Eigen::Vector3d& p_site) const;
  /// Returns the column of `col` on the circle.
  int wrapped(int col) const { return col < 0 ? col + columns_ : (col >= columns_ ? col - columns_ : col); }
  bool contains_row(int row) const { return row >= 0 && row < rows_; }

  /// Returns whether the surface continues between neighboring pixels.
  bool is_connected_right(Pixel pixel) const { return has(pixel, kPixelRight); }
  bool is_connected_left(Pixel pixel) const { return has({wrapped(pixel.col - 1), pixel.row}, kPixelRight); }
  bool is_connected_up(Pixel pixel) const { return has(pixel, kPixelUp); }
  bool is_connected_down(Pixel pixel) const { return pixel.row > 0 && has({pixel.col, pixel.row - 1}, kPixelUp); }

  /// Returns the unit normal at a pixel from its connected neighbors, toward the scanner, in site. Across a direction
  /// without connected neighbors the surface is taken as perpendicular to the beam.
  Eigen::Vector3d normal(Pixel pixel) const;
  /// Returns the angle between the beams of neighboring columns at a row, rad.
  double column_angle_rad(int row) const {
    return step_rad_ * static_cast<double>(row_cosine_[static_cast<std::size_t>(row)]);
  }

 private:
  std::size_t index(Pixel pixel) const {
    return static_cast<std::size_t>(pixel.col) * static_cast<std::size_t>(rows_) + static_cast<std::size_t>(pixel.row);
  }
  void find_grid(const std::vector<Eigen::Vector3f>& directions);
  void fill_pixels(const io::StationScan& scan);
  void interpolate_gaps();
  void connect();

  Pose3 T_site_scanner_;
  Eigen::Matrix3d R_site_scanner_ = Eigen::Matrix3d::Identity();
  int columns_ = 0, rows_ = 0;
  double step_rad_ = 0.0;
  double max_range_m_ = 0.0;
  double hidden_part_ = 0.0;
  double azimuth_rad_ = 0.0;    ///< azimuth of column 0
  double elevation_rad_ = 0.0;  ///< elevation of row 0
  std::vector<float> range_m_, intensity_;
  std::vector<std::uint8_t> state_;
  std::vector<Eigen::Vector2d> col_direction_;  ///< cosine and sine of the azimuth, [column]
  std::vector<float> row_cosine_, row_sine_;    ///< cosine and sine of the elevation, [row]
};

/// Returns whether the surface continues between two neighboring beams with ranges b and c, beside them a and d (0: no
/// return). `angle_rad`: angle between the beams.
bool is_continuous(float a_m, float b_m, float c_m, float d_m, double angle_rad);

}  // namespace patrol::importer
