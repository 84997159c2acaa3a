#pragma once

#include <Eigen/Geometry>
#include <mujoco/mujoco.h>

namespace patrol::sim {

/// Returns the box around a geom along the axes of world, m: that of its own bounding box at the poses in `data`.
/// Planes have no end, and no box.
inline Eigen::AlignedBox3d geom_box(const mjModel& model, const mjData& data, int geom) {
  using RowMatrix = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const Eigen::Map<const Eigen::Vector3d> position(data.geom_xpos + 3 * geom), middle(model.geom_aabb + 6 * geom),
      half(model.geom_aabb + 6 * geom + 3);
  const Eigen::Map<const RowMatrix> rotation(data.geom_xmat + 9 * geom);
  const Eigen::Vector3d center = position + rotation * middle, reach = rotation.cwiseAbs() * half;
  return {center - reach, center + reach};
}

}  // namespace patrol::sim
