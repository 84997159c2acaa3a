#pragma once

#include <mujoco/mujoco.h>

#include "core/state/state_archive_fwd.h"

namespace patrol::sim {

/// Saves or restores all fields of MuJoCo's data but the timers and the statistics of the solver. `data` is that of
/// `model` or of a model that was compiled from the same input. Throws std::runtime_error if the sizes differ.
void serialize_state(const mjModel& model, mjData& data, StateArchive& archive);

/// Saves or restores the fields of the physics model that the simulator changes while it runs, but the bounding-volume
/// tree of the collision culler.
void serialize_state(mjModel& physics, StateArchive& archive);

}  // namespace patrol::sim
