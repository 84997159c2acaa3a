#include "importer/site/enclosing_solid.h"

#include <algorithm>
#include <cmath>

#include "sim/mujoco.h"

namespace patrol::importer {
namespace {

/// Whether a point in the frame of a mesh is inside its convex hull.
bool is_inside_hull(const mjModel& site, int mesh, const Eigen::Vector3d& p) {
  const int first = site.mesh_polyadr[mesh], count = site.mesh_polynum[mesh];
  for (int polygon = first; polygon < first + count; ++polygon) {
    const int vertex = site.mesh_vertadr[mesh] + site.mesh_polyvert[site.mesh_polyvertadr[polygon]];
    const Eigen::Vector3d corner = Eigen::Map<const Eigen::Vector3f>(site.mesh_vert + 3 * vertex).cast<double>();
    const Eigen::Map<const Eigen::Vector3d> normal(site.mesh_polynormal + 3 * polygon);
    if (normal.dot(p - corner) > 0.0) return false;
  }
  return count > 0;
}

bool is_inside_geom(const mjModel& site, int geom, const Eigen::Vector3d& p) {
  const Eigen::Map<const Eigen::Vector3d> size(site.geom_size + 3 * geom);
  const double radius = p.head<2>().norm();
  switch (site.geom_type[geom]) {
    case mjGEOM_BOX:
      return ((size - p.cwiseAbs()).array() >= 0.0).all();
    case mjGEOM_SPHERE:
      return p.norm() <= size.x();
    case mjGEOM_ELLIPSOID:
      return p.cwiseQuotient(size).norm() <= 1.0;
    case mjGEOM_CYLINDER:
      return radius <= size.x() && std::abs(p.z()) <= size.y();
    case mjGEOM_CAPSULE:
      return std::hypot(radius, std::max(0.0, std::abs(p.z()) - size.y())) <= size.x();
    case mjGEOM_MESH:
      return is_inside_hull(site, site.geom_dataid[geom], p);
    default:
      return false;
  }
}

}  // namespace

bool is_touchable(const mjModel& site, int geom) {
  return site.geom_contype[geom] != 0 || site.geom_conaffinity[geom] != 0;
}

std::optional<std::string> enclosing_solid(const mjModel& site, const mjData& data, const Eigen::Vector3d& point_m) {
  for (int geom = 0; geom < site.ngeom; ++geom) {
    if (!is_touchable(site, geom)) continue;
    const Eigen::Map<const Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor>> R(data.geom_xmat + 9 * geom);
    const Eigen::Vector3d p = R.transpose() * (point_m - Eigen::Map<const Eigen::Vector3d>(data.geom_xpos + 3 * geom));
    if (is_inside_geom(site, geom, p)) return std::string(sim::name_of(site, mjOBJ_GEOM, geom));
  }
  return std::nullopt;
}

bool is_below_back_face(const mjModel& site, const mjData& data, const Eigen::Vector3d& point_m) {
  constexpr mjtByte kSeenGroups[mjNGROUP] = {1, 0, 1, 0, 0, 0};
  const mjtNum up[3] = {0.0, 0.0, 1.0};
  mjtNum normal[3] = {0.0, 0.0, 0.0};
  const mjtNum distance = mj_ray(&site, &data, point_m.data(), up, kSeenGroups, true, -1, nullptr, normal);
  return distance >= 0.0 && normal[2] > 0.0;
}

}  // namespace patrol::importer
