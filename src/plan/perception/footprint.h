#pragma once

#include <Eigen/Core>

#include <vector>

namespace patrol::plan {

/// A disc fixed to the body.
struct Disc {
  Eigen::Vector2d center_m = Eigen::Vector2d::Zero();  ///< in level
  double radius_m = 0.0;
};

/// The robot's outline on the ground as a planner needs it. With a distance field, rows of discs that cover the polygon
/// answers "does it fit, and how far is the next obstacle" in a few look-ups, and never says free where the polygon is not.
class Footprint {
 public:
  /// `polygon_m`: convex, counter-clockwise, in level. The discs stick out over the long sides of its bounding box by at
  /// most `max_excess_m`, over its ends by less than half the width of a row: a wide robot that must come near to things
  /// with its ends wants two rows, at twice the price. Throws InputError when the polygon is not one (fewer than three
  /// corners, the body's origin outside).
  explicit Footprint(std::vector<Eigen::Vector2d> polygon_m, int rows = 1, double max_excess_m = 0.03);

  const std::vector<Eigen::Vector2d>& polygon_m() const { return polygon_m_; }
  const std::vector<Disc>& discs() const { return discs_; }
  double inscribed_radius_m() const { return inscribed_radius_m_; }          ///< about the body's origin
  double circumscribed_radius_m() const { return circumscribed_radius_m_; }  ///< likewise

 private:
  std::vector<Eigen::Vector2d> polygon_m_;
  std::vector<Disc> discs_;
  double inscribed_radius_m_ = 0.0;
  double circumscribed_radius_m_ = 0.0;
};

}  // namespace patrol::plan
