#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "importer/robot/source_robot.h"

namespace patrol::importer {

/// Surface of the shapes of a robot with all joints at zero, in the base.
class RobotSurface {
 public:
  /// Adds a shape of a link.
  void add(const std::string& link, const Shape& shape, const Pose3& T_base_link);

  /// Point relative to the surface.
  struct Clearance {
    double distance_m = 0.0;  ///< from the nearest shape; negative inside
    std::string link;         ///< link of the nearest shape
  };
  /// Returns the clearance of a point; none if all shapes are at least `max_m` away.
  std::optional<Clearance> clearance(const Eigen::Vector3d& p_base, double max_m) const;

 private:
  struct Part {
    std::string link;
    Shape shape;  ///< in the base
    Mesh mesh;    ///< in the base; of mesh shapes only
    Eigen::AlignedBox3d box;
  };
  std::vector<Part> parts_;
};

}  // namespace patrol::importer
