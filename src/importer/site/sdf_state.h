#pragma once

#include <map>
#include <string>

#include "importer/site/sdf_world.h"

namespace patrol::importer {

/// Poses of a model by the <state> of a world.
struct SdfModelState {
  Pose3 T_world_model;
  std::map<std::string, Pose3> links = {};           ///< T_world_link by the name of the link
  std::map<std::string, SdfModelState> models = {};  ///< nested models
};

/// Returns the states of the models in the first <state> of a world. Gazebo Classic applies it after it has loaded the
/// models, and ignores further ones. Poses of models and links are in world.
std::map<std::string, SdfModelState> model_states(const sdf::World& world);

}  // namespace patrol::importer
