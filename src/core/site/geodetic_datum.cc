#include "core/site/geodetic_datum.h"

#include <cmath>

#include "core/geometry/angles.h"

namespace patrol {
namespace {

constexpr double kEarthRadius_m = 6378137.0;  // equatorial radius of WGS 84
constexpr double kEccentricitySquared = 6.69437999014e-3;

/// Lengths of one radian of latitude and of longitude at a datum.
struct Radii {
  double meridian_m, parallel_m;
};

Radii radii_at(const GeodeticDatum& datum) {
  const double sine = std::sin(datum.latitude_deg * kDegree);
  const double w = std::sqrt(1.0 - kEccentricitySquared * sine * sine);
  return {.meridian_m = kEarthRadius_m * (1.0 - kEccentricitySquared) / (w * w * w),
          .parallel_m = kEarthRadius_m / w * std::cos(datum.latitude_deg * kDegree)};
}

}  // namespace

GeodeticPosition to_geodetic(const GeodeticDatum& datum, const Eigen::Vector2d& p_site_m) {
  const Radii radii = radii_at(datum);
  return {.latitude_deg = datum.latitude_deg + p_site_m.y() / radii.meridian_m / kDegree,
          .longitude_deg = datum.longitude_deg + p_site_m.x() / radii.parallel_m / kDegree};
}

Eigen::Vector2d to_site(const GeodeticDatum& datum, const GeodeticPosition& position) {
  const Radii radii = radii_at(datum);
  const double east_deg = std::remainder(position.longitude_deg - datum.longitude_deg, 360.0);
  return {east_deg * kDegree * radii.parallel_m,
          (position.latitude_deg - datum.latitude_deg) * kDegree * radii.meridian_m};
}

}  // namespace patrol
