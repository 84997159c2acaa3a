#include "importer/site/sdf_state.h"

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

}  // namespace patrol::importer
