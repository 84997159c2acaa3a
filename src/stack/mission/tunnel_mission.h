#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/messages.h"
#include "core/navigation_goal.h"
#include "core/route.h"
#include "core/settings.h"
#include "stack/mission/mission.h"

namespace patrol::stack {

struct TunnelMissionSettings {
  int navigations = 10;           ///< times that the goals are driven to, each from a restart of the localisation
  bool starts_docked = true;      ///< otherwise the robot does not know where it is, and localises from scratch
  bool starts_at_survey = false;  ///< a robot without a post, at the surveyed start: localizes from there, and goes on between navigations
  bool docks = true;              ///< after the mapping drive and each navigation
  double start_wait_s = 4.0;      ///< standing still at first: sensors settle, their biases are learnt
  double start_look_s = 1.5;      ///< of that, at least so long from the first step on: the map's first scan is taken standing
  double stand_s = 1.0;           ///< at a goal, before it is reported
  double position_tol_m = 0.03;   ///< at a goal; never more than its own accuracy asks
  double yaw_tol_rad = 0.017;
  double remote_silence_s = 2.0;  ///< without a command the remote control counts as switched off
  double lost_patience_s = 30.0;  ///< standing still, not knowing where it is, before it says that it cannot tell
  std::string mark_types = "";    ///< of the goals marked on the mapping drive, in their order (core/route.h); N for the rest
  double driver_patience_s = 120.0;  ///< at a goal of type R: without a command so long, it goes on by itself

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("navigations", self.navigations, between(0, 1000));
    visit("starts_docked", self.starts_docked);
    visit("starts_at_survey", self.starts_at_survey);
    visit("docks", self.docks);
    visit("start_wait_s", self.start_wait_s, between(0.0, 600.0));
    visit("start_look_s", self.start_look_s, between(0.0, 600.0));
    visit("stand_s", self.stand_s, between(0.0, 60.0));
    visit("position_tol_m", self.position_tol_m, between(0.005, 5.0));
    visit("yaw_tol_rad", self.yaw_tol_rad, between(0.002, 3.2));
    visit("remote_silence_s", self.remote_silence_s, between(0.2, 60.0));
    visit("lost_patience_s", self.lost_patience_s, between(1.0, 600.0));
    visit("mark_types", self.mark_types);
    visit("driver_patience_s", self.driver_patience_s, between(1.0, 3600.0));
  }

  /// Type of the goal of that index, from 0. Throws InputError when `mark_types` holds another letter than those of `kGoalTypes`.
  GoalType type_of_mark(std::size_t index) const;
};

/// Paper 004's experiment (section 4.2): a drive by remote control makes the map and marks the goals; then, again and again, the robot
/// restarts at its post, drives to every goal, stands there, and comes back. Without a remote control the map and the goals are given.
///
/// At goals of type D it scans the lining. At one of type R it waits for a person, who drives it on (over the trestle bridge, say),
/// marks where it shall sound for water, drives it back and hands over again: it goes on by itself from there. (On a tour that makes its own
/// map the person has been at the mapping drive, and R is as good as N.)
///
/// Events: goal_marked, mapping_done, navigation_started, goal_reached, goal_failed, inspection_failed, remote_requested, remote_ended,
/// docked, dock_failed, lost, relocalized, cannot_localize, mission_completed (every goal of every navigation reached, every inspection and
/// docking done), mission_failed. Subjects are "goal_2", "navigation_7", "sounding_1"; a goal's value is the number of its navigation.
class TunnelMission final : public Mission {
 public:
  /// `goals` in map; empty: they are marked on the way. Without a map the remote control comes first, to make one; with a map, only at
  /// goals of type R. Throws InputError when there is neither a goal nor a remote control.
  TunnelMission(const TunnelMissionSettings& settings, std::vector<MarkedGoal> goals, bool has_remote, bool has_map = false);

  MissionOutput step(Time now, const MissionInput& input) override;
  bool is_over() const override { return phase_ == Phase::kOver; }
  Event abort(Time now, EventKind kind, const std::string& text) override;
  TaskTiming timing() const override { return TaskTiming::kNow; }
  bool starts_at_survey() const override { return settings_.starts_at_survey; }
  const std::vector<MarkedGoal>& goals() const { return goals_; }

 private:
  enum class Phase { kWaiting, kRemote, kUndocking, kDriving, kStanding, kScanning, kHandedOver, kSounding, kDocking, kOver };

  void wait(MissionOutput& output);
  void follow_remote(const MissionInput& input, MissionOutput& output);
  void undock(const MissionInput& input);
  void drive(const MissionInput& input, MissionOutput& output);
  void stand(MissionOutput& output);
  void scan(const MissionInput& input, MissionOutput& output);
  void hand_over(const MissionInput& input, MissionOutput& output);
  void sound(const MissionInput& input, MissionOutput& output);
  void dock(const MissionInput& input, MissionOutput& output);
  bool watch_localization(const MissionInput& input, MissionOutput& output);
  Task task() const;
  Relocalization relocalization() const;
  void start_navigation(MissionOutput& output);
  void next_goal(MissionOutput& output);
  void end_navigation(MissionOutput& output);
  void finish(MissionOutput& output);
  void enter(Phase phase);
  Event event(EventKind kind, const std::string& subject, const std::string& text, double value = 0.0) const;
  std::string goal_name() const;
  std::string sounding_name() const;

  TunnelMissionSettings settings_;
  std::vector<MarkedGoal> goals_;
  bool has_remote_;
  bool has_map_;
  bool is_docked_;
  Phase phase_ = Phase::kWaiting;
  std::optional<Time> first_step_;
  Time phase_start_{};
  Time last_remote_{};
  int navigation_ = 0;        ///< 1 is the first
  std::size_t goal_ = 0;
  int num_soundings_ = 0;
  int num_failed_ = 0;
  std::optional<Time> lost_since_;
  Time now_{};
  Pose2 T_map_body_;
};

}  // namespace patrol::stack
