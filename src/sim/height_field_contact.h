#pragma once

#include <vector>

#include <Eigen/Core>
#include <mujoco/mujoco.h>

namespace patrol::sim {

/// Contact of a sphere with a surface.
struct SphereContact {
  Eigen::Vector3d point;   ///< nearest point of the surface
  Eigen::Vector3d normal;  ///< unit vector from the surface to the sphere's center
  double distance_m;       ///< from the surface to the sphere; negative: depth of penetration
};

/// Returns the contacts of a sphere with a height field of `model`, nearer than `margin_m`; `center` and the result are
/// in the frame of the field's geom.
///
/// Each contact is a local minimum of the distance to the field's triangles, in closed form [Ericson05, 5.1.5]: one on
/// even ground, two in a furrow, none at edges inside even ground.
std::vector<SphereContact> contacts_with_height_field(const mjModel& model, int hfield, const Eigen::Vector3d& center,
                                                      double radius_m, double margin_m);

/// Makes MuJoCo find the contacts of spheres with height fields by `contacts_with_height_field`, in all models of the
/// process. MuJoCo's general algorithm for convex shapes finds one contact per triangle iteratively, in ten times the
/// time.
void use_closed_form_sphere_contacts();

}  // namespace patrol::sim
