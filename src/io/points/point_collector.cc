#include "io/points/point_collector.h"

#include <cmath>

namespace patrol::io {
namespace {

/// Converts numbers to a point; returns false if one is not finite as a float.
bool make_point(const std::array<double, 4>& numbers, ScannerPoint& point) {
  constexpr double kMaxValue = 1e30;
  for (const double number : numbers) {
    if (!(std::abs(number) < kMaxValue)) return false;
  }
  point = {static_cast<float>(numbers[0]), static_cast<float>(numbers[1]), static_cast<float>(numbers[2]),
           static_cast<float>(numbers[3])};
  return true;
}

}  // namespace

Eigen::Vector3d origin_of(const Eigen::Vector3d& first, double unit_m) {
  constexpr double kNear_m = 10'000.0, kStep_m = 100.0;
  if (unit_m * first.cwiseAbs().maxCoeff() <= kNear_m) return Eigen::Vector3d::Zero();
  const double step = kStep_m / unit_m;
  return step * (first / step).array().round();
}

bool PointCollector::add(std::array<double, 4> numbers) {
  ScannerPoint point{};
  if (shift_ != nullptr) {
    const Eigen::Vector3d position(numbers[0], numbers[1], numbers[2]);
    if (!position.allFinite() || !std::isfinite(numbers[3])) {
      ++shift_->num_dropped;
      return true;
    }
    if (!shift_->origin) shift_->origin = origin_of(position, shift_->unit_m);
    for (int axis = 0; axis < 3; ++axis) numbers[static_cast<std::size_t>(axis)] -= (*shift_->origin)[axis];
  }
  if (!make_point(numbers, point)) return false;
  points_.push_back(point);
  return true;
}

}  // namespace patrol::io
