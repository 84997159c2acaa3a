#include "importer/site/sdf_state.h"

#include <algorithm>

namespace patrol::importer {
namespace {

std::string last_name(const std::string& scoped) {
  const std::size_t at = scoped.rfind("::");
  return at == std::string::npos ? scoped : scoped.substr(at + 2);
}

std::map<std::string, SdfModelState> states_below(const sdf::ElementPtr& element) {
  std::map<std::string, SdfModelState> states;
  if (!element->HasElement("model")) return states;
  for (sdf::ElementPtr model = element->GetElement("model"); model; model = model->GetNextElement("model")) {
    if (!model->HasElement("pose")) continue;
    SdfModelState state{.T_world_model = to_pose(model->Get<ignition::math::Pose3d>("pose"))};
    if (model->HasElement("link")) {
      for (sdf::ElementPtr link = model->GetElement("link"); link; link = link->GetNextElement("link")) {
        if (link->HasElement("pose"))
          state.links[last_name(link->Get<std::string>("name"))] = to_pose(link->Get<ignition::math::Pose3d>("pose"));
      }
    }
    if (model->HasElement("scale")) {
      const auto scale = model->Get<ignition::math::Vector3d>("scale");
      state.scale = {scale.X(), scale.Y(), scale.Z()};
    }
    state.models = states_below(model);
    states[last_name(model->Get<std::string>("name"))] = std::move(state);
  }
  return states;
}

}  // namespace

std::map<std::string, SdfModelState> model_states(const sdf::World& world) {
  const sdf::ElementPtr element = world.Element();
  if (!element->HasElement("state")) return {};
  return states_below(element->GetElement("state"));
}

void apply_scale(const Eigen::Vector3d& scale, SiteShape& shape) {
  switch (shape.type) {
    case SiteShapeType::kBox:
    case SiteShapeType::kEllipsoid:
      shape.size_m = shape.size_m.cwiseProduct(scale);
      return;
    case SiteShapeType::kCylinder:
    case SiteShapeType::kCapsule:
      shape.size_m = shape.size_m.cwiseProduct(Eigen::Vector3d(std::max(scale.x(), scale.y()), scale.z(), 1.0));
      return;
    case SiteShapeType::kSphere:
      shape.size_m *= scale.maxCoeff();
      return;
    case SiteShapeType::kMesh:
      shape.mesh = scaled(shape.mesh, scale);
      return;
    case SiteShapeType::kPlane:
    case SiteShapeType::kHeightField:
      return;
  }
}

}  // namespace patrol::importer
