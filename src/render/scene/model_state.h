#pragma once

#include <mujoco/mujoco.h>

#include "core/ground_truth.h"

namespace patrol::render {

/// Sets robot and actors to a logged state and computes the poses of all geoms. Throws InputError when the state does
/// not belong to this model.
void put_state(const mjModel& model, const SimState& state, mjData& data);

}  // namespace patrol::render
