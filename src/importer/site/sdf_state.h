#pragma once

#include <map>
#include <string>

#include <Eigen/Core>

#include "importer/site/imported_site.h"
#include "importer/site/sdf_world.h"

namespace patrol::importer {

/// Poses and scale of a model by the <state> of a world.
struct SdfModelState {
  Pose3 T_world_model;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();   ///< scale of the shapes of the model's links
  std::map<std::string, Pose3> links = {};           ///< T_world_link by the name of the link
  std::map<std::string, SdfModelState> models = {};  ///< nested models
};

/// Returns the states of the models in the first <state> of a world. Gazebo Classic applies it after it has loaded the
/// models, and ignores further ones. Poses of models and links are in world.
std::map<std::string, SdfModelState> model_states(const sdf::World& world);

/// Scales a shape about its origin as Gazebo Classic does (physics::Link::SetScale): boxes and meshes along their axes,
/// radii of cylinders by the larger one of x and y, radii of spheres by the largest. Planes and height fields are not
/// scaled.
void apply_scale(const Eigen::Vector3d& scale, SiteShape& shape);

}  // namespace patrol::importer
