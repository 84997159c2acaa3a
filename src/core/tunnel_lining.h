#pragma once

#include <Eigen/Core>

#include <vector>

#include "core/frames.h"

namespace patrol {

/// A piece of a tunnel's axis of one curvature.
struct AxisElement {
  double length_m = 0.0;
  double curvature_1pm = 0.0;  ///< to the left; 0: straight
};

/// Where a point is in a tunnel.
struct TunnelPlace {
  double chainage_m = 0.0;  ///< along the axis
  double left_m = 0.0;      ///< of the axis
  double height_m = 0.0;
};

/// The design of a lined tunnel, as the surveyors have it: axis, section and rings. Heights are over the invert. The section is a
/// horseshoe: a half circle, and below its centre the arcs of the side walls.
///
/// Clock positions are of one who looks along the axis: 0 deg the crown (12 o'clock), 90 deg the right wall at the height of the
/// half circle's centre (3 o'clock), 270 deg the left.
struct TunnelLining {
  Pose2 T_route_start;              ///< of the axis at chainage 0, x along it; in the route's frame
  std::vector<AxisElement> axis;    ///< goes on beyond its ends as it is there
  double crown_radius_m = 0.0;
  double crown_centre_m = 0.0;      ///< height of the half circle's centre
  double side_radius_m = 0.0;       ///< of the walls below it
  double first_ring_m = 0.0;        ///< chainage at which ring 1 begins
  double ring_length_m = 0.0;
  int rings = 0;                    ///< 1 ... rings

  /// In the route's frame, from chainage and offset to the left; and backwards.
  Eigen::Vector2d point_at(double chainage_m, double left_m) const;
  TunnelPlace place_of(const Eigen::Vector3d& p_route) const;
  double heading_at(double chainage_m) const;  ///< in the route's frame, rad

  /// 0 where there is none.
  int ring_at(double chainage_m) const;
  double middle_of_ring_m(int ring) const { return first_ring_m + (ring - 0.5) * ring_length_m; }

  /// About the half circle's centre, 0 ... 360.
  double clock_deg(const TunnelPlace& place) const;
  /// From that centre to the intrados in a direction, m.
  double radius_at(double clock_deg) const;
  /// A point of the intrados, in the route's frame.
  Eigen::Vector3d intrados(double chainage_m, double clock_deg) const;
};

}  // namespace patrol
