#include "render/scene/model_state.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"

namespace patrol::render {

void put_state(const mjModel& model, const SimState& state, mjData& data) {
  const auto num_qpos = static_cast<std::size_t>(model.nq), num_mocap = static_cast<std::size_t>(model.nmocap);
  if (state.qpos.size() != num_qpos || state.mocap.size() != 7 * num_mocap) {
    throw InputError(
        fmt::format("logged state has {} coordinates and {} poses, the model {} and {}: the log belongs to another "
                    "world or robot",
                    state.qpos.size(), state.mocap.size() / 7, num_qpos, num_mocap));
  }
  std::copy(state.qpos.begin(), state.qpos.end(), data.qpos);
  for (std::size_t body = 0; body < num_mocap; ++body) {
    const auto pose = state.mocap.begin() + static_cast<std::ptrdiff_t>(7 * body);
    std::copy(pose, pose + 3, data.mocap_pos + 3 * body);
    std::copy(pose + 3, pose + 7, data.mocap_quat + 4 * body);
  }
  mj_kinematics(&model, &data);
}

}  // namespace patrol::render
