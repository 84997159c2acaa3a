#include "importer/site/points/panorama_patches.h"

#include <algorithm>
#include <cmath>

namespace patrol::importer {
namespace {

constexpr int kMaxSide_px = 64;
constexpr int kMaxSquare_px = 16;

/// Rectangle of pixels on one plane.
struct PixelRectangle {
  Pixel begin = {};  ///< lowest column and row
  int width = 0;     ///< columns; 0: joined to another
  int height = 0;    ///< rows
  PointMoments moments = {};
  double light_sum = 0.0;  ///< sum of the intensities
};

/// Returns the length of a step across a beam when it is projected onto a plane along the beam, up to an incidence of
/// 85 degrees.
double length_on_plane(const Eigen::Vector3d& step, const Eigen::Vector3d& normal, const Eigen::Vector3d& beam) {
  constexpr double kMinCosine = 0.087;
  const double cosine = std::max(kMinCosine, std::abs(normal.dot(beam)));
  return step.norm() * std::hypot(1.0, normal.dot(step.normalized()) / cosine);
}

class PatchMaker {
 public:
  PatchMaker(const Panorama& scan, const PanoramaPatchSettings& settings,
             const std::function<float(float, double)>& reflectivity)
      : scan_(scan), settings_(settings), reflectivity_(reflectivity) {}

  std::vector<Patch> make() {
    for (int col = 0; col < scan_.columns(); col += kMaxSquare_px) {
      for (int row = 0; row < scan_.rows(); row += kMaxSquare_px) divide({col, row}, kMaxSquare_px);
    }
    index_rectangles();
    for (bool is_changed = true; is_changed;) {
      const bool is_wider = join_all(true);
      is_changed = join_all(false) || is_wider;
    }
    std::vector<Patch> patches;
    for (const PixelRectangle& rectangle : rectangles_) {
      if (rectangle.width > 0) patches.push_back(patch_of(rectangle));
    }
    return patches;
  }

 private:
  double max_residual_m(double range_m) const {
    return settings_.max_residual_m + settings_.max_residual_per_m * range_m;
  }

  PixelRectangle rectangle_of(Pixel begin, int width, int height) const {
    PixelRectangle rectangle{.begin = begin, .width = width, .height = height};
    for (int col = begin.col; col < begin.col + width; ++col) {
      for (int row = begin.row; row < begin.row + height; ++row) {
        const Pixel pixel{col, row};
        const Eigen::Vector3d d = scan_.direction(pixel), p = double{scan_.range_m(pixel)} * d;
        rectangle.moments.add(p);
        // A pixel without neighbors is a small piece across its beam.
        const double half_m = 0.2 * scan_.step_rad() * double{scan_.range_m(pixel)};
        rectangle.moments.products += half_m * half_m * (Eigen::Matrix3d::Identity() - d * d.transpose());
        rectangle.light_sum += double{scan_.intensity(pixel)};
      }
    }
    return rectangle;
  }

  /// Returns whether all pixels are within the largest residual of the plane and see it from one side.
  bool is_on(const FittedPlane& plane, Pixel begin, int width, int height) const {
    const double height_m = plane.normal().dot(plane.center);
    for (int col = begin.col; col < begin.col + width; ++col) {
      for (int row = begin.row; row < begin.row + height; ++row) {
        const double range_m = double{scan_.range_m({col, row})};
        const double along_m = range_m * plane.normal().dot(scan_.direction(Pixel{col, row}));
        if (std::abs(along_m - height_m) > max_residual_m(range_m)) return false;
      }
    }
    return true;
  }

  /// Divides a square into the largest squares on planes and appends them.
  void divide(Pixel begin, int side) {
    const int width = std::min(side, scan_.columns() - begin.col), height = std::min(side, scan_.rows() - begin.row);
    if (width <= 0 || height <= 0) return;
    bool is_needed = false, is_whole = true;
    for (int col = begin.col; col < begin.col + width; ++col) {
      for (int row = begin.row; row < begin.row + height; ++row) {
        const Pixel pixel{col, row};
        if (!scan_.is_usable(pixel)) {
          is_whole = false;
          continue;
        }
        is_needed = is_needed || !scan_.has(pixel, kPixelCovered);
        if (col + 1 < begin.col + width && !scan_.is_connected_right(pixel)) is_whole = false;
        if (row + 1 < begin.row + height && !scan_.is_connected_up(pixel)) is_whole = false;
      }
    }
    if (!is_needed) return;
    if (is_whole) {
      const PixelRectangle rectangle = rectangle_of(begin, width, height);
      if (side == 1 || is_on(fit_plane(rectangle.moments), begin, width, height)) {
        rectangles_.push_back(rectangle);
        return;
      }
    }
    const int half = side / 2;
    for (const int dc : {0, half}) {
      for (const int dr : {0, half}) divide({begin.col + dc, begin.row + dr}, half);
    }
  }

  std::size_t index(Pixel pixel) const {
    return static_cast<std::size_t>(pixel.col) * static_cast<std::size_t>(scan_.rows()) +
           static_cast<std::size_t>(pixel.row);
  }

  void index_rectangles() {
    owner_.assign(static_cast<std::size_t>(scan_.columns()) * static_cast<std::size_t>(scan_.rows()), -1);
    for (std::size_t i = 0; i < rectangles_.size(); ++i) own(i);
  }
  void own(std::size_t i) {
    const PixelRectangle& rectangle = rectangles_[i];
    for (int col = 0; col < rectangle.width; ++col) {
      for (int row = 0; row < rectangle.height; ++row)
        owner_[index({rectangle.begin.col + col, rectangle.begin.row + row})] = static_cast<int>(i);
    }
  }

  /// Joins rectangles with the next one along the rows or the columns.
  bool join_all(bool is_along_row) {
    bool is_changed = false;
    for (std::size_t i = 0; i < rectangles_.size(); ++i) {
      while (rectangles_[i].width > 0 && join_next(i, is_along_row)) is_changed = true;
    }
    return is_changed;
  }

  bool join_next(std::size_t i, bool is_along_row) {
    PixelRectangle& a = rectangles_[i];
    const Pixel next =
        is_along_row ? Pixel{a.begin.col + a.width, a.begin.row} : Pixel{a.begin.col, a.begin.row + a.height};
    if (next.col >= scan_.columns() || next.row >= scan_.rows() || owner_[index(next)] < 0) return false;
    PixelRectangle& b = rectangles_[static_cast<std::size_t>(owner_[index(next)])];
    const bool is_matching = is_along_row ? b.begin.row == a.begin.row && b.height == a.height
                                          : b.begin.col == a.begin.col && b.width == a.width;
    if (!is_matching || b.begin.col != next.col || b.begin.row != next.row) return false;
    const int width = is_along_row ? a.width + b.width : a.width,
              height = is_along_row ? a.height : a.height + b.height;
    if (width > kMaxSide_px || height > kMaxSide_px || !is_connected(a, is_along_row)) return false;
    const double light_step = std::abs(a.light_sum / a.moments.n - b.light_sum / b.moments.n);
    const float one = reflectivity_(1.0f, 1.0);
    if (light_step * double{one} > settings_.max_reflectivity_step) return false;
    PointMoments joint = a.moments;
    joint += b.moments;
    const FittedPlane plane = fit_plane(joint);
    if (plane.std_m[0] > 0.5 * max_residual_m(plane.center.norm()) || !is_on(plane, a.begin, width, height))
      return false;
    a.moments = joint;
    a.light_sum += b.light_sum;
    a.width = width;
    a.height = height;
    b.width = 0;
    own(i);
    return true;
  }

  /// Returns whether the surface continues across the whole far edge of a rectangle.
  bool is_connected(const PixelRectangle& a, bool is_along_row) const {
    if (is_along_row) {
      for (int row = 0; row < a.height; ++row) {
        if (!scan_.is_connected_right({a.begin.col + a.width - 1, a.begin.row + row})) return false;
      }
      return true;
    }
    for (int col = 0; col < a.width; ++col) {
      if (!scan_.is_connected_up({a.begin.col + col, a.begin.row + a.height - 1})) return false;
    }
    return true;
  }

  /// Returns the normal toward the scanner: that of the plane, or for rectangles of one column or row, which determine
  /// no plane, the mean of those of the pixels with their neighbors.
  Eigen::Vector3d normal_of(const PixelRectangle& rectangle, const FittedPlane& plane) const {
    if (rectangle.width > 1 && rectangle.height > 1)
      return plane.normal().dot(plane.center) > 0.0 ? Eigen::Vector3d(-plane.normal()) : plane.normal();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int col = 0; col < rectangle.width; ++col) {
      for (int row = 0; row < rectangle.height; ++row)
        sum += scan_.normal({rectangle.begin.col + col, rectangle.begin.row + row});
    }
    return sum.norm() > 1e-6 ? Eigen::Vector3d(sum.normalized()) : Eigen::Vector3d(-plane.center.normalized());
  }

  /// Returns whether the surface continues nowhere across the edge of a rectangle on the side (dc, dr).
  bool is_end(const PixelRectangle& rectangle, int dc, int dr) const {
    const int width = dc == 0 ? rectangle.width : 1, height = dr == 0 ? rectangle.height : 1;
    for (int i = 0; i < width; ++i) {
      for (int k = 0; k < height; ++k) {
        const Pixel pixel{rectangle.begin.col + (dc > 0 ? rectangle.width - 1 : i),
                          rectangle.begin.row + (dr > 0 ? rectangle.height - 1 : k)};
        if (dc > 0 ? scan_.is_connected_right(pixel)
                   : (dc < 0 ? scan_.is_connected_left(pixel)
                             : (dr > 0 ? scan_.is_connected_up(pixel) : scan_.is_connected_down(pixel))))
          return false;
      }
    }
    return true;
  }

  Patch patch_of(const PixelRectangle& rectangle) const {
    const FittedPlane plane = fit_plane(rectangle.moments);
    const Eigen::Vector3d normal = normal_of(rectangle, plane);
    const double range_m = plane.center.norm();
    double nearest_m = 1e9, max_range_m = 0.0;
    for (int col = 0; col < rectangle.width; ++col) {
      for (int row = 0; row < rectangle.height; ++row) {
        const double r = double{scan_.range_m({rectangle.begin.col + col, rectangle.begin.row + row})};
        nearest_m = std::min(nearest_m, r);
        max_range_m = std::max(max_range_m, r);
      }
    }
    // Lengths of a pixel on the plane along the rows and along the columns.
    const Eigen::Vector3d d_center = plane.center / range_m,
                          aside = scan_.direction(rectangle.begin.col + 1.0, rectangle.begin.row) -
                                  scan_.direction(rectangle.begin.col, rectangle.begin.row),
                          upward = scan_.direction(rectangle.begin.col, rectangle.begin.row + 1.0) -
                                   scan_.direction(rectangle.begin.col, rectangle.begin.row);
    const double row_m = range_m * length_on_plane(aside, normal, d_center),
                 col_m = range_m * length_on_plane(upward, normal, d_center);
    const auto more = [&](bool is_end, double pixel_m) {
      return is_end ? settings_.silhouette_px + settings_.end_overlap_m / pixel_m : 0.5 + settings_.overlap_m / pixel_m;
    };
    const double left = rectangle.begin.col + rectangle.width - 1 + more(is_end(rectangle, 1, 0), row_m),
                 right = rectangle.begin.col - more(is_end(rectangle, -1, 0), row_m);
    const double bottom = rectangle.begin.row - more(is_end(rectangle, 0, -1), col_m),
                 top = rectangle.begin.row + rectangle.height - 1 + more(is_end(rectangle, 0, 1), col_m);
    // Counterclockwise seen from the scanner: columns grow to the left.
    const double corners[4][2] = {{left, bottom}, {right, bottom}, {right, top}, {left, top}};
    Patch patch{.corners_m = {}, .num_corners = 4};
    for (std::size_t i = 0; i < 4; ++i) {
      const Eigen::Vector3d d = scan_.direction(corners[i][0], corners[i][1]);
      const double cosine = normal.dot(d);
      double r = std::abs(cosine) > 1e-3 ? normal.dot(plane.center) / cosine : range_m;
      r = std::clamp(r, 0.94 * nearest_m, 1.06 * max_range_m);
      patch.corners_m[i] = (scan_.origin() + r * d).cast<float>();
    }
    patch.spacing_m = static_cast<float>(scan_.step_rad() * range_m);
    const double cosine = std::max(0.1, -normal.dot(plane.center) / range_m);
    patch.reflectivity = reflectivity_(static_cast<float>(rectangle.light_sum / rectangle.moments.n), cosine);
    return patch;
  }

  const Panorama& scan_;
  const PanoramaPatchSettings& settings_;
  const std::function<float(float, double)>& reflectivity_;
  std::vector<PixelRectangle> rectangles_;
  std::vector<int> owner_;  ///< [pixel], index of its rectangle, or -1
};

}  // namespace

std::vector<Patch> patches_of(const Panorama& scan, const PanoramaPatchSettings& settings,
                              const std::function<float(float intensity, double cosine)>& reflectivity) {
  return PatchMaker(scan, settings, reflectivity).make();
}

}  // namespace patrol::importer
