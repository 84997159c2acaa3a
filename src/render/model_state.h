#pragma once

#include <mujoco/mujoco.h>

#include "core/ground_truth.h"

namespace patrol::render {

/// Moves robot and actors to where a logged state has them, and works out where every geom is. Throws InputError when the state
/// is not one of this model.
void put_state(const mjModel& model, const SimState& state, mjData& data);

}  // namespace patrol::render
