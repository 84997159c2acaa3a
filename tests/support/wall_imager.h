#pragma once

#include <cstddef>
#include <memory>

#include "sim/sensors/depth_camera.h"

namespace patrol::test {

/// Depth imager that draws a wall 2 m ahead.
class WallImager : public sim::DepthImager {
 public:
  explicit WallImager(const sim::PinholeLens& lens)
      : pixels_(static_cast<std::size_t>(lens.width_px * lens.height_px)) {}
  void draw(const sim::BodyPoses&, const Pose3&, sim::IdealDepthImage& image) override {
    image.depth_m.assign(pixels_, 2.0F);
    image.reflectivity.assign(pixels_, 1.0F);
  }

 private:
  std::size_t pixels_;
};

inline std::unique_ptr<sim::DepthImager> make_wall_imager(const mjModel&, const sim::PinholeLens& lens, double,
                                                          double) {
  return std::make_unique<WallImager>(lens);
}

}  // namespace patrol::test
