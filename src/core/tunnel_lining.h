#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/frames.h"

namespace patrol {

/// Section of the tunnel axis with constant curvature.
struct AxisElement {
  double length_m = 0.0;
  double curvature_1pm = 0.0;  ///< positive to the left; 0: straight
};

/// Tunnel coordinates of a point.
struct TunnelCoordinates {
  double chainage_m = 0.0;  ///< distance along the axis
  double left_m = 0.0;      ///< lateral offset from the axis, positive to the left
  double height_m = 0.0;
};

/// Surveyed design of a lined tunnel: axis, cross section and rings. Heights are above the invert. The section is a
/// horseshoe: a half circle above the arcs of the side walls.
///
/// Clock positions are for a viewer who looks along the axis. 0 deg is the crown (12 o'clock). 90 deg (3 o'clock) is
/// the right wall at the height of the center of the half circle, 270 deg the left wall.
struct TunnelLining {
  Pose2 T_route_start;            ///< pose of the axis at chainage 0, x along the axis, in the frame of the route
  std::vector<AxisElement> axis;  ///< extrapolated beyond both ends with the curvature there
  double crown_radius_m = 0.0;
  double crown_center_m = 0.0;  ///< height of the center of the half circle
  double side_radius_m = 0.0;   ///< radius of the side walls below the half circle
  double first_ring_m = 0.0;    ///< chainage at the start of ring 1
  double ring_length_m = 0.0;
  int rings = 0;  ///< number of rings, numbered from 1

  /// Returns the point at a chainage and an offset to the left, in the frame of the route.
  Eigen::Vector2d point_at(double chainage_m, double left_m) const;
  TunnelCoordinates to_tunnel_coordinates(const Eigen::Vector3d& p_route) const;
  double heading_at(double chainage_m) const;  ///< heading of the axis in the frame of the route, rad

  /// Returns the ring number at a chainage; 0 outside the rings.
  int ring_at(double chainage_m) const;
  double middle_of_ring_m(int ring) const { return first_ring_m + (ring - 0.5) * ring_length_m; }

  /// Returns the clock position around the center of the half circle, 0 to 360.
  double clock_deg(const TunnelCoordinates& coordinates) const;
  /// Returns the distance from the center of the half circle to the intrados in a direction, m.
  double radius_at(double clock_deg) const;
  /// Returns a point of the intrados in the frame of the route.
  Eigen::Vector3d intrados(double chainage_m, double clock_deg) const;
};

}  // namespace patrol
