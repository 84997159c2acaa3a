#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "core/time.h"

namespace patrol::render {

/// Kinds of highlights in order of decreasing priority.
enum class HighlightKind {
  kCollision,
  kFall,
  kKidnap,       ///< moved to another pose
  kLost,         ///< localization lost
  kAlarm,        ///< finding of the inspection
  kRelocalized,  ///< localization recovered
  kFault,        ///< start of a sensor fault
  kFailure,      ///< failure of a sensor, an inspection, a goal, a station, a docking or the mission
  kNearMiss,
  kMaxError,
  kCorrection,  ///< jump of the estimate: loop closure or change of hypothesis
  kDocking,
  kGoal,     ///< goal or station reached
  kMission,  ///< start or end of the mission
};

/// Highlight of a run.
struct Highlight {
  Time at{};
  HighlightKind kind{};
  std::string title;                                    ///< short description
  std::optional<Eigen::Vector2d> p_world_subject = {};  ///< position of the highlight, m; none if it is the robot's own
  double subject_height_m = 0.0;                        ///< height of the subject over the robot's body
};

}  // namespace patrol::render
