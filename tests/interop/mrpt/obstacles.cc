#include "obstacles.h"

#include <cmath>

namespace mrpt_stack {
namespace {

constexpr double kDepthRange_m = 2.5, kMinHeight_m = 0.06, kMaxHeight_m = 0.5;
constexpr double kCell_m = 0.05;
constexpr Time kMemory = std::chrono::seconds(12);
constexpr int kMinPoints = 2;  ///< minimum number of points of an image in a cell

}  // namespace

void LowObstacles::add(const patrol::DepthImage& image, const Pose2& T_odom_body) {
  std::map<std::pair<int, int>, int> counts;
  for (int row = 0; row < image.height; ++row) {
    for (int col = 0; col < image.width; ++col) {
      const double depth_m = 1e-3 * image.depth_mm[static_cast<std::size_t>(row * image.width + col)];
      if (depth_m <= 0.0 || depth_m > kDepthRange_m) continue;
      const Eigen::Vector3d p_camera{depth_m, (image.cx_px - col) * depth_m / image.fx_px,
                                     (image.cy_px - row) * depth_m / image.fy_px};
      const Eigen::Vector3d p_body = T_body_camera_ * p_camera;
      const double height_m = p_body.z() - ground_m_;
      if (height_m < kMinHeight_m || height_m > kMaxHeight_m) continue;
      const Eigen::Vector2d p_odom = T_odom_body * Eigen::Vector2d(p_body.head<2>());
      ++counts[{static_cast<int>(std::floor(p_odom.x() / kCell_m)),
                static_cast<int>(std::floor(p_odom.y() / kCell_m))}];
    }
  }
  for (const auto& [cell, count] : counts) {
    if (count >= kMinPoints) last_seen_[cell] = image.stamp;
  }
}

void LowObstacles::append_to(mrpt::maps::CSimplePointsMap& points, Time now, const Pose2& T_odom_body) {
  const Pose2 T_body_odom = T_odom_body.inverse();
  std::erase_if(last_seen_, [&](const auto& entry) {
    const auto& [cell, seen] = entry;
    const Eigen::Vector2d p_body =
        T_body_odom * Eigen::Vector2d((cell.first + 0.5) * kCell_m, (cell.second + 0.5) * kCell_m);
    if (now - seen > kMemory) return true;  // a person has gone on
    points.insertPoint(static_cast<float>(p_body.x()), static_cast<float>(p_body.y()), 0.0F);
    return false;
  });
}

}  // namespace mrpt_stack
