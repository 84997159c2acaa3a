#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "core/random.h"
#include "core/sensors/registry.h"

namespace patrol::test {

/// Ground of any height and boxes on it, seen by a depth camera of 80 by 60 pixels, 74 by 59 degrees, no noise of its
/// own.
class DepthScene {
 public:
  using Height = std::function<double(double x, double y)>;

  explicit DepthScene(Height ground_m = [](double, double) { return 0.0; }) : ground_m_(std::move(ground_m)) {}
  DepthScene& add_box(const Eigen::Vector3d& min, const Eigen::Vector3d& max) {
    boxes_.push_back({min, max});
    return *this;
  }
  double ground_m(double x, double y) const { return ground_m_(x, y); }

  DepthImage look(const Pose3& T_world_camera, Time stamp = {}) const {
    DepthImage image{.stamp = stamp,
                     .width = 80,
                     .height = 60,
                     .fx_px = 53.0,
                     .fy_px = 53.0,
                     .cx_px = 39.5,
                     .cy_px = 29.5,
                     .depth_mm = {}};
    for (int row = 0; row < image.height; ++row) {
      for (int col = 0; col < image.width; ++col) {
        const Eigen::Vector3d ray(1.0, (image.cx_px - col) / image.fx_px, (image.cy_px - row) / image.fy_px);
        const double depth = cast(T_world_camera.position, T_world_camera.rotation * ray);
        image.depth_mm.push_back(depth < 10.0 ? static_cast<std::uint16_t>(std::lround(1000.0 * depth)) : 0);
      }
    }
    return image;
  }

 private:
  struct Box {
    Eigen::Vector3d min, max;
  };

  /// Steps of 1 cm, the last one halved.
  double cast_ground(const Eigen::Vector3d& from, const Eigen::Vector3d& ray) const {
    const auto is_above = [&](double s) {
      const Eigen::Vector3d p = from + s * ray;
      return p.z() > ground_m_(p.x(), p.y());
    };
    double s = 0.0;
    while (is_above(s + 0.01)) {
      if ((s += 0.01) > 8.0) return std::numeric_limits<double>::infinity();
    }
    for (double step = 0.005; step > 1e-5; step /= 2.0) s += is_above(s + step) ? step : 0.0;
    return s;
  }

  static double cast_box(const Box& box, const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
    double enter = 0.0, leave = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (box.min[axis] - from[axis]) / ray[axis], b = (box.max[axis] - from[axis]) / ray[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave ? enter : std::numeric_limits<double>::infinity();
  }

  double cast(const Eigen::Vector3d& from, const Eigen::Vector3d& ray) const {
    double depth = cast_ground(from, ray);
    for (const Box& box : boxes_) depth = std::min(depth, cast_box(box, from, ray));
    return depth;
  }

  Height ground_m_;
  std::vector<Box> boxes_;
};

/// Standard deviation `std_per_m` times the depth squared, m.
inline DepthImage with_noise(DepthImage image, double std_per_m, const RandomStream& noise, std::uint64_t tick) {
  for (std::size_t pixel = 0; pixel < image.depth_mm.size(); ++pixel) {
    if (image.depth_mm[pixel] == 0) continue;
    const double depth = 1e-3 * image.depth_mm[pixel];
    const double noisy = depth + std_per_m * depth * depth * noise.normal(tick, pixel);
    image.depth_mm[pixel] = static_cast<std::uint16_t>(std::lround(1000.0 * std::max(0.05, noisy)));
  }
  return image;
}

}  // namespace patrol::test
