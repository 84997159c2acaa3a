#include "core/state/state_archive.h"
#include "sim/locomotion/quadruped_drive.h"
#include "sim/locomotion/track_drive.h"
#include "sim/locomotion/wheel_drive.h"

namespace patrol::sim {

void QuadrupedDrive::serialize_state(StateArchive& archive) { archive(controller_); }
void TrackDrive::serialize_state(StateArchive& archive) { archive(controller_); }
void WheelDrive::serialize_state(StateArchive& archive) { archive(controller_); }

}  // namespace patrol::sim
