#pragma once

#include <vector>

#include <Eigen/Core>

namespace patrol::plan {

/// Disc fixed to the body.
struct Disc {
  Eigen::Vector2d center_m = Eigen::Vector2d::Zero();  ///< in level
  double radius_m = 0.0;
};

/// Outline of the robot on the ground, covered by rows of discs. With a distance field, the discs give the clearance of
/// a pose in a few look-ups. The discs cover the polygon, so that a pose in collision is never reported as free.
class Footprint {
 public:
  /// `polygon_m`: convex, counter-clockwise, in level. The discs extend beyond the long sides of the bounding box by at
  /// most `max_excess_m`, beyond its ends by less than half the width of a row. Two rows suit a wide robot whose ends
  /// must come near to objects, at twice the computation time. Throws InputError if the polygon has fewer than three
  /// corners or does not contain the body's origin.
  explicit Footprint(std::vector<Eigen::Vector2d> polygon_m, int rows = 1, double max_excess_m = 0.03);

  const std::vector<Eigen::Vector2d>& polygon_m() const { return polygon_m_; }
  const std::vector<Disc>& discs() const { return discs_; }
  double inscribed_radius_m() const { return inscribed_radius_m_; }          ///< radius about the body's origin
  double circumscribed_radius_m() const { return circumscribed_radius_m_; }  ///< radius about the body's origin

 private:
  std::vector<Eigen::Vector2d> polygon_m_;
  std::vector<Disc> discs_;
  double inscribed_radius_m_ = 0.0;
  double circumscribed_radius_m_ = 0.0;
};

}  // namespace patrol::plan
