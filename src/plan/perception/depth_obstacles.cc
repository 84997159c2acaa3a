#include "plan/perception/depth_obstacles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace patrol::plan {
namespace {

constexpr float kNoDepth = std::numeric_limits<float>::quiet_NaN();

/// Point of a pixel, in level.
struct Point {
  float x = 0.0F, y = 0.0F;
  float z = kNoDepth;  ///< NaN without a measurement
  bool is_valid() const { return !std::isnan(z); }
};

/// Median of the values that are not NaN; NaN if fewer than two. Of an even number of values the lower middle one,
/// which is the nearer or lower point.
template <std::size_t N>
float median(std::array<float, N> values) {
  std::size_t count = 0;
  for (float& value : values) {
    count += std::isnan(value) ? 0 : 1;
    value = std::isnan(value) ? std::numeric_limits<float>::infinity() : value;
  }
  for (std::size_t round = 0; round < N; ++round) {  // odd-even transposition sort, without branches
    for (std::size_t i = round % 2; i + 1 < N; i += 2) {
      const float low = std::min(values[i], values[i + 1]), high = std::max(values[i], values[i + 1]);
      values[i] = low, values[i + 1] = high;
    }
  }
  return count < 2 ? kNoDepth : values[(count - 1) / 2];
}

/// Points of a depth image, [row][column], median filtered along the row.
class PointImage {
 public:
  PointImage(const DepthImage& image, const Pose3& T_level_camera, double max_range_m) : width_(image.width) {
    const Eigen::Matrix3f R = T_level_camera.rotation.toRotationMatrix().cast<float>();
    const Eigen::Vector3f t = T_level_camera.position.cast<float>();
    points_.resize(image.depth_mm.size());
    const auto depth_at = [&](int row, int col) {
      if (col < 0 || col >= image.width) return kNoDepth;
      const std::uint16_t mm = image.depth_mm[index(row, col)];
      return mm == 0 ? kNoDepth : 1e-3F * static_cast<float>(mm);
    };
    for (int row = 0; row < image.height; ++row) {
      const auto up = static_cast<float>((image.cy_px - row) / image.fy_px);
      for (int col = 0; col < image.width; ++col) {
        const float depth = median<3>({depth_at(row, col - 1), depth_at(row, col), depth_at(row, col + 1)});
        if (!(depth <= static_cast<float>(max_range_m))) continue;
        const auto left = static_cast<float>((image.cx_px - col) / image.fx_px);
        const Eigen::Vector3f p = R * (depth * Eigen::Vector3f(1.0F, left, up)) + t;
        points_[index(row, col)] = {p.x(), p.y(), p.z()};
      }
    }
  }

  const Point& at(int row, int col) const { return points_[index(row, col)]; }

  /// Median over five columns of a row.
  Point around(int row, int col) const {
    std::array<float, 5> x{}, y{}, z{};
    for (int i = 0; i < 5; ++i) {
      const int there = col + i - 2;
      const Point point = there < 0 || there >= width_ ? Point{} : at(row, there);
      const auto slot = static_cast<std::size_t>(i);
      x[slot] = point.is_valid() ? point.x : kNoDepth;
      y[slot] = point.is_valid() ? point.y : kNoDepth;
      z[slot] = point.z;
    }
    return {median(x), median(y), median(z)};
  }

 private:
  std::size_t index(int row, int col) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(col);
  }

  int width_;
  std::vector<Point> points_;
};

}  // namespace

DepthPoints segment_obstacles(const DepthObstaclesSettings& settings, const DepthImage& image,
                              const Pose3& T_level_camera, double body_height_m) {
  const PointImage points(image, T_level_camera, settings.max_range_m);
  std::vector<Point> ground(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  const auto index = [&](int row, int col) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(col);
  };
  for (int row = 0; row < image.height; ++row) {
    for (int col = 0; col < image.width; ++col) ground[index(row, col)] = points.around(row, col);
  }

  const auto min_rise = static_cast<float>(settings.min_rise_m), max_slope = static_cast<float>(settings.max_slope);
  const Eigen::Vector2d p_level_camera = T_level_camera.position.head<2>();
  DepthPoints result;
  for (int row = 0; row < image.height; ++row) {
    const int last = std::min(image.height - 1, row + settings.ground_search_rows);
    for (int col = 0; col < image.width; ++col) {
      const Point& p = points.at(row, col);
      if (!p.is_valid()) continue;
      bool rises = false;
      for (int below = row + 1; below <= last && !rises; ++below) {
        const Point& q = ground[index(below, col)];
        const float rise = p.z - q.z;  // NaN if q is: no rise
        rises = rise > min_rise && rise > min_rise + max_slope * std::hypot(p.x - q.x, p.y - q.y);
      }
      const Eigen::Vector2d point(p.x, p.y);
      const double range_m = (point - p_level_camera).norm();
      const double height_limit_m = settings.max_height_m + settings.max_slope * range_m - body_height_m;
      if (rises && p.z < height_limit_m) result.obstacles_m.push_back(point);
      if (!rises && row < last && range_m <= settings.clearing_range_m) result.ground_m.push_back(point);
    }
  }
  return result;
}

}  // namespace patrol::plan
