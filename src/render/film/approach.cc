#include "render/film/approach.h"

#include <string_view>

#include <fmt/format.h>

#include "core/frames.h"
#include "render/scene/model_state.h"

namespace patrol::render {
namespace {

/// Main body of a pedestrian's limb. Pedestrians consist of several mocap bodies: "pedestrian_1",
/// "pedestrian_1_thigh_left", ...
int main_body(const mjModel& model, int part) {
  const std::string_view name = sim::name_of(model, mjOBJ_BODY, part);
  for (int body = 0; body < model.nbody; ++body) {
    const std::string_view main = sim::name_of(model, mjOBJ_BODY, body);
    const bool can_have_limbs = model.body_mocapid[body] >= 0 && !main.empty();
    if (can_have_limbs && name.starts_with(std::string(main) + "_")) return body;
  }
  return part;
}

Eigen::Vector3d place_of(const mjData& data, int geom) { return Eigen::Vector3d(data.geom_xpos + 3 * geom); }

}  // namespace

ApproachFinder::ApproachFinder(const mjModel& view) : model_(view), data_(sim::make_data(view)) {
  const int robot = mj_name2id(&view, mjOBJ_BODY, frame_id::kBody);
  for (int geom = 0; geom < view.ngeom; ++geom) {
    const int body = view.geom_bodyid[geom];
    if (robot >= 0 && view.body_rootid[body] == view.body_rootid[robot]) robot_.push_back(geom);
    if (view.body_mocapid[body] >= 0) actors_.push_back({geom, main_body(view, body)});
  }
}

std::optional<Approach> ApproachFinder::nearest(const SimState& state) {
  put_state(model_, state, *data_);
  double nearest_m = kMaxRange_m;
  const Part* who = nullptr;
  for (const Part& part : actors_) {
    for (const int geom : robot_) {
      const double distance_bound_m = (place_of(*data_, part.geom) - place_of(*data_, geom)).norm() -
                                      model_.geom_rbound[part.geom] - model_.geom_rbound[geom];
      if (distance_bound_m >= nearest_m) continue;
      const double clearance_m = mj_geomDistance(&model_, data_.get(), geom, part.geom, nearest_m, nullptr);
      if (clearance_m >= nearest_m) continue;
      nearest_m = clearance_m;
      who = &part;
    }
  }
  if (who == nullptr) return std::nullopt;
  const double* p_world_actor = data_->xpos + 3 * who->actor;
  const std::string_view name = sim::name_of(model_, mjOBJ_BODY, who->actor);
  return Approach{.at = state.stamp,
                  .actor = name.empty() ? fmt::format("body {}", who->actor) : std::string(name),
                  .clearance_m = nearest_m,
                  .p_world_actor = {p_world_actor[0], p_world_actor[1]}};
}

}  // namespace patrol::render
