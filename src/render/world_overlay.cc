#include "render/world_overlay.h"

#include <algorithm>
#include <cmath>

namespace patrol::render {
namespace {

constexpr double kMinWidth = 1.6 / 720.0;  // fraction of the frame's height

}  // namespace

/// Projected line segment; 1 / distance is linear along it.
struct WorldOverlay::Stroke {
  Eigen::Vector2d from, to;
  double inverse_from, inverse_to;        ///< 1/m
  double half_width_from, half_width_to;  ///< pixels
};

WorldOverlay::WorldOverlay(Frame& frame, const std::vector<float>& depth, const Projector& projector)
    : frame_(frame), depth_(depth), projector_(projector), coverage_(depth.size(), 0) {}

void WorldOverlay::polyline(std::span<const Eigen::Vector3d> points_m, double width_m, const Brush& brush) {
  for (std::size_t i = 1; i < points_m.size(); ++i) {
    stroke(projector_.to_camera(points_m[i - 1]), projector_.to_camera(points_m[i]), width_m);
  }
  blend_in(brush);
}

void WorldOverlay::dots(std::span<const Eigen::Vector3d> points_m, double radius_m, const Brush& brush) {
  for (const Eigen::Vector3d& point : points_m) {
    const Eigen::Vector3d in_camera = projector_.to_camera(point);
    stroke(in_camera, in_camera, 2.0 * radius_m);
  }
  blend_in(brush);
}

void WorldOverlay::stroke(const Eigen::Vector3d& from_in_camera, const Eigen::Vector3d& to_in_camera, double width_m) {
  Eigen::Vector3d a = from_in_camera, b = to_in_camera;
  const double near_m = projector_.near_m();
  if (a.z() < near_m && b.z() < near_m) return;
  if (a.z() < near_m) a = b + (b.z() - near_m) / (b.z() - a.z()) * (a - b);
  if (b.z() < near_m) b = a + (a.z() - near_m) / (a.z() - b.z()) * (b - a);
  const Projected from = projector_.project_camera(a), to = projector_.project_camera(b);
  const auto half_width = [&](double distance_m) {
    return 0.5 * std::max(kMinWidth * frame_.height(), projector_.focal_px() * width_m / distance_m);
  };
  cover({.from = from.pixel,
         .to = to.pixel,
         .inverse_from = 1.0 / from.distance_m,
         .inverse_to = 1.0 / to.distance_m,
         .half_width_from = half_width(from.distance_m),
         .half_width_to = half_width(to.distance_m)});
}

void WorldOverlay::cover(const Stroke& stroke) {
  const Eigen::Vector2d along = stroke.to - stroke.from;
  const double reach = std::max(stroke.half_width_from, stroke.half_width_to) + 0.5;
  const Eigen::Vector2d low = stroke.from.cwiseMin(stroke.to).array() - reach;
  const Eigen::Vector2d high = stroke.from.cwiseMax(stroke.to).array() + reach;
  if (!(high.x() >= 0.0 && high.y() >= 0.0 && low.x() < frame_.width() && low.y() < frame_.height())) return;
  const int top = static_cast<int>(std::max(0.0, low.y()));
  const int bottom = static_cast<int>(std::min(frame_.height() - 1.0, high.y()));
  top_ = bottom_ < top_ ? top : std::min(top_, top);
  bottom_ = std::max(bottom_, bottom);

  const double squared = std::max(along.squaredNorm(), 1e-12);
  for (int y = top; y <= bottom; ++y) {
    // Only the columns that the slanted segment can cover in this row.
    double first = low.x(), last = high.x();
    if (std::abs(along.y()) > 1.0) {
      const double slope = along.x() / along.y();
      const double middle = stroke.from.x() + slope * (y + 0.5 - stroke.from.y());
      const double spread = reach * std::hypot(1.0, slope) + 1.0;
      first = std::max(first, middle - spread);
      last = std::min(last, middle + spread);
    }
    const int left = static_cast<int>(std::max(0.0, first));
    const int right = static_cast<int>(std::min(frame_.width() - 1.0, last));
    for (int x = left; x <= right; ++x) {
      const Eigen::Vector2d p(x + 0.5, y + 0.5);
      const double t = std::clamp((p - stroke.from).dot(along) / squared, 0.0, 1.0);
      const double half_width = stroke.half_width_from + t * (stroke.half_width_to - stroke.half_width_from);
      const double coverage = std::clamp(half_width + 0.5 - (p - stroke.from - t * along).norm(), 0.0, 1.0);
      const auto pixel = static_cast<std::size_t>(y * frame_.width() + x);
      const auto covered = static_cast<std::uint8_t>(std::lround(255.0 * coverage));
      if (covered <= coverage_[pixel]) continue;
      if (is_hidden(pixel, 1.0 / (stroke.inverse_from + t * (stroke.inverse_to - stroke.inverse_from)))) continue;
      coverage_[pixel] = covered;
    }
  }
}

// Tolerance: one pixel away, flat ground observed from a height of 1 m is nearer or farther by this much, and must not
// occlude a line on it.
bool WorldOverlay::is_hidden(std::size_t pixel, double distance_m) const {
  const double tolerance_m = 0.04 + 1.5 * distance_m * distance_m / projector_.focal_px();
  return distance_m > projector_.distance_m(depth_[pixel]) + tolerance_m;
}

void WorldOverlay::blend_in(const Brush& brush) {
  for (int y = top_; y <= bottom_; ++y) {
    for (int x = 0; x < frame_.width(); ++x) {
      std::uint8_t& covered = coverage_[static_cast<std::size_t>(y * frame_.width() + x)];
      if (covered == 0) continue;
      frame_.at(x, y) = blend(frame_.at(x, y), brush.color, brush.opacity * covered / 255.0);
      covered = 0;
    }
  }
  top_ = 0;
  bottom_ = -1;
}

}  // namespace patrol::render
