#include "core/state/state_archive.h"
#include "plan/navigation/back_up.h"
#include "plan/navigation/maneuver_follower.h"
#include "plan/navigation/route_follower.h"
#include "plan/navigation/spin.h"
#include "plan/navigation/wait.h"

namespace patrol::plan {

void RouteFollower::serialize_state(StateArchive& archive) { archive(path_, along_m_); }

void ManeuverFollower::serialize_state(StateArchive& archive) {
  RouteFollower::serialize_state(archive);
  archive(maneuver_, next_, weights_);
}

void BackUp::serialize_state(StateArchive& archive) { archive(until_); }
void Spin::serialize_state(StateArchive& archive) { archive(until_, turned_rad_, yaw_before_rad_); }
void Wait::serialize_state(StateArchive& archive) { archive(until_); }

}  // namespace patrol::plan
