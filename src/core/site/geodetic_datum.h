#pragma once

#include <Eigen/Core>

namespace patrol {

/// WGS 84 position of the origin of `site`. The x axis of `site` points east, its y axis north.
struct GeodeticDatum {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
};

/// WGS 84 latitude and longitude.
struct GeodeticPosition {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
};

/// Converts a position in `site`, east and north in m, to WGS 84. Uses the ellipsoid's radii of curvature at the datum:
/// the error is quadratic in the distance, 1 mm at 110 m and 9 cm at 1 km for the latitudes of the worlds.
GeodeticPosition to_geodetic(const GeodeticDatum& datum, const Eigen::Vector2d& p_site_m);

/// Converts a WGS 84 position to `site`, in m. Inverse of `to_geodetic`, with the same error.
Eigen::Vector2d to_site(const GeodeticDatum& datum, const GeodeticPosition& position);

}  // namespace patrol
