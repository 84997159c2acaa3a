#pragma once

#include <optional>
#include <vector>

#include "core/frames.h"
#include "importer/robot/source_robot.h"

namespace patrol::importer {

/// Shape in cylindrical coordinates about the axis of a joint.
struct AxialShape {
  bool is_round = false;
  bool is_sphere = false;
  double radius_m = 0.0;                    ///< largest distance from the axis
  double min_m = 0.0, max_m = 0.0;          ///< extent along the axis
  double rim_min_m = 0.0, rim_max_m = 0.0;  ///< extent along the axis; of a mesh, only the part near the radius
};

/// Measures a shape of a link. `T_axis_link`: z along the axis.
AxialShape axial_shape(const Shape& shape, const Pose3& T_axis_link);

/// Returns the largest round shapes as one: the wheel. None if another shape protrudes.
std::optional<AxialShape> round_hull(const std::vector<AxialShape>& shapes);

}  // namespace patrol::importer
