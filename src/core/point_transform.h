#pragma once

#include <cmath>

#include <Eigen/Core>

#include "core/frames.h"

namespace patrol {

/// Transforms many points by one pose: sine and cosine are computed once. Equal to `T_a_b * p_b` to the bit.
class PointTransform {
 public:
  explicit PointTransform(const Pose2& T_a_b)
      : x_(T_a_b.x), y_(T_a_b.y), cos_(std::cos(T_a_b.yaw)), sin_(std::sin(T_a_b.yaw)) {}

  Eigen::Vector2d operator()(const Eigen::Vector2d& p_b) const {
    return {x_ + cos_ * p_b.x() - sin_ * p_b.y(), y_ + sin_ * p_b.x() + cos_ * p_b.y()};
  }

 private:
  double x_, y_, cos_, sin_;
};

}  // namespace patrol
