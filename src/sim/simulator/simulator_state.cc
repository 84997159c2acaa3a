#include "core/state/message_state.h"
#include "core/state/state_archive.h"
#include "sim/simulator/mujoco_state.h"
#include "sim/simulator/simulator.h"

namespace patrol::sim {

// Kinematics, forces and contacts in MuJoCo's data belong to `now_` and are restored with it.
void Simulator::serialize_state(StateArchive& archive) {
  archive.section("simulator");
  sim::serialize_state(*model_.physics, archive);
  sim::serialize_state(*model_.physics, *data_, archive);
  archive(culler_, locomotion_, actors_, sensors_);
  archive.part(antenna_);
  archive.part(operator_);
  archive(num_replayed_, command_, now_, collisions_, contacts_);
}

}  // namespace patrol::sim
