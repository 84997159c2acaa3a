#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/messages.h"
#include "core/navigation_goal.h"
#include "core/route.h"
#include "core/sensors/registry.h"
#include "core/settings.h"
#include "stack/mission/localization_monitor.h"
#include "stack/mission/mission.h"
#include "stack/mission/tunnel_mission_settings.h"

namespace patrol::stack {

/// Mission after the experiment of [Liu21, section 4.2].
///
/// A teleoperated drive makes the map and saves the goals. Then the robot repeatedly restarts at its post, drives to
/// every goal, stands there, and returns. Without teleoperation, the map and the goals are given.
///
/// At goals of type D it scans the lining. At a goal of type R it waits for an operator, who drives it on (e.g. over
/// the trestle bridge), requests soundings, drives it back and hands over control. If the mission makes its own map,
/// the operator was present at the mapping drive, and R is treated as N.
///
/// Events: goal_saved, goal_moved, mapping_completed, navigation_started, goal_reached, goal_failed, inspection_failed,
/// teleop_requested, teleop_ended, docked, dock_failed, localization_lost, relocalized, localization_failed. At the end
/// mission_completed (every goal of every run reached, every inspection and docking done) or mission_failed. Subjects
/// are "goal_2", "navigation_7", "sounding_1"; the value of a goal event is the number of its run.
class TunnelMission final : public Mission {
 public:
  /// `goals`: in map; empty: they are saved during teleoperation. Without a map, teleoperation comes first, to make
  /// one; with a map, it is only used at goals of type R. Throws InputError when there are neither goals nor
  /// teleoperation.
  TunnelMission(const TunnelMissionSettings& settings, std::vector<SavedGoal> goals, bool has_teleop,
                bool has_map = false);

  MissionOutput step(Time now, const MissionInput& input) override;
  std::vector<Event> correct_map(Time now, const localize::MapCorrection& correction) override;
  bool is_over() const override { return phase_ == Phase::kOver; }
  Event abort(Time now, EventKind kind, const std::string& text) override;
  TaskTiming timing() const override { return TaskTiming::kNow; }
  bool starts_at_survey() const override { return settings_.start_at_survey; }
  const std::vector<SavedGoal>& goals() const { return goals_; }
  void serialize_state(StateArchive& archive) override;

 private:
  enum class Phase {
    kWaiting,
    kTeleop,
    kUndocking,
    kDriving,
    kStanding,
    kScanning,
    kTeleopAtGoal,
    kSounding,
    kDocking,
    kOver
  };

  void wait(const MissionInput& input, MissionOutput& output);
  void teleoperate(const MissionInput& input, MissionOutput& output);
  void undock(const MissionInput& input, MissionOutput& output);
  void drive(const MissionInput& input, MissionOutput& output);
  void stand(MissionOutput& output);
  void scan(const MissionInput& input, MissionOutput& output);
  void await_teleop(const MissionInput& input, MissionOutput& output);
  void sound(const MissionInput& input, MissionOutput& output);
  void dock(const MissionInput& input, MissionOutput& output);
  bool monitor_localization(const MissionInput& input, MissionOutput& output);
  Task task() const;
  Relocalization relocalization() const;
  void start_run(MissionOutput& output);
  void next_goal(MissionOutput& output);
  void end_run(MissionOutput& output);
  void finish(MissionOutput& output);
  void enter(Phase phase);
  Event event(EventKind kind, const std::string& subject, const std::string& text, double value = 0.0) const;
  std::string goal_name() const;
  std::string sounding_name() const;

  TunnelMissionSettings settings_;
  std::vector<SavedGoal> goals_;
  std::vector<Time> saved_;  ///< [goal] stamp at which teleoperation saved it; empty for given goals
  bool has_teleop_;
  bool has_map_;
  bool is_docked_;
  Phase phase_ = Phase::kWaiting;
  std::optional<Time> first_step_;
  Time phase_start_{};
  Time last_teleop_{};
  int run_ = 0;  ///< number of the present run, from 1
  std::size_t goal_ = 0;
  int num_soundings_ = 0;
  int num_failed_ = 0;
  LocalizationMonitor localization_;
  Time now_{};
  Pose2 T_map_body_;
};

}  // namespace patrol::stack
