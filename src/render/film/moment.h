#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "core/time.h"

namespace patrol::render {

/// What a run is remembered by; the first is the most worth a look.
enum class MomentKind {
  kCollision,
  kFall,
  kKidnap,       ///< lifted to another place
  kLost,         ///< says that it does not know where it is
  kAlarm,        ///< a finding
  kRelocalized,  ///< knows again where it is
  kFault,        ///< of a sensor, begins
  kFailure,      ///< of a goal, a station, a docking, the mission
  kNearMiss,
  kLargestError,
  kCorrection,   ///< the estimate jumps: a loop closes, or a guess is given up
  kDocking,
  kGoal,         ///< or station, reached
  kMission,      ///< begins, ends
};

struct Moment {
  Time at{};
  MomentKind kind{};
  std::string title;  ///< a few words for a person
  std::optional<Eigen::Vector2d> p_world_subject = {};  ///< what it is about, m, where that is not the robot itself
};

}  // namespace patrol::render
