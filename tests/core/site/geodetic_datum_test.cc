#include "core/site/geodetic_datum.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"

namespace patrol::geodetic_datum_test {
namespace {

/// Earth-centered coordinates of a point on the ellipsoid, from the defining constants of WGS 84.
Eigen::Vector3d to_ecef(const GeodeticPosition& position) {
  constexpr double kRadius_m = 6378137.0, kFlattening = 1.0 / 298.257223563;
  constexpr double kE2 = kFlattening * (2.0 - kFlattening);
  const double lat = position.latitude_deg * kDegree, lon = position.longitude_deg * kDegree;
  const double normal_m = kRadius_m / std::sqrt(1.0 - kE2 * std::sin(lat) * std::sin(lat));
  return {normal_m * std::cos(lat) * std::cos(lon), normal_m * std::cos(lat) * std::sin(lon),
          normal_m * (1.0 - kE2) * std::sin(lat)};
}

/// East and north in the tangent plane at the datum, by way of the Earth's center.
Eigen::Vector2d to_tangent_plane(const GeodeticDatum& datum, const GeodeticPosition& position) {
  const Eigen::Vector3d d = to_ecef(position) - to_ecef({datum.latitude_deg, datum.longitude_deg});
  const double lat = datum.latitude_deg * kDegree, lon = datum.longitude_deg * kDegree;
  const Eigen::Vector3d east(-std::sin(lon), std::cos(lon), 0.0);
  const Eigen::Vector3d north(-std::sin(lat) * std::cos(lon), -std::sin(lat) * std::sin(lon), std::cos(lat));
  return {east.dot(d), north.dot(d)};
}

TEST(GeodeticDatum, AgreesWithTheTangentPlaneToAMillimeterOverABlock) {
  for (const double latitude_deg : {-40.0, 0.0, 29.21}) {
    const GeodeticDatum datum{.latitude_deg = latitude_deg, .longitude_deg = 119.46};
    for (const Eigen::Vector2d& p : {Eigen::Vector2d(100.0, 30.0), Eigen::Vector2d(-60.0, 80.0)}) {
      EXPECT_LT((to_tangent_plane(datum, to_geodetic(datum, p)) - p).norm(), 1e-3) << latitude_deg;
    }
  }
}

TEST(GeodeticDatum, BothDirectionsAreInverse) {
  const GeodeticDatum datum{.latitude_deg = 29.21, .longitude_deg = 119.46};
  const Eigen::Vector2d p(-12.5, 873.0);
  EXPECT_LT((to_site(datum, to_geodetic(datum, p)) - p).norm(), 1e-7);
}

TEST(GeodeticDatum, CrossesTheDateLine) {
  const GeodeticDatum datum{.latitude_deg = 10.0, .longitude_deg = 179.9999};
  const Eigen::Vector2d p = to_site(datum, {.latitude_deg = 10.0, .longitude_deg = -179.9999});
  EXPECT_NEAR(p.x(), 2e-4 * kDegree * 6378137.0 * std::cos(10.0 * kDegree), 0.01);
}

}  // namespace
}  // namespace patrol::geodetic_datum_test
