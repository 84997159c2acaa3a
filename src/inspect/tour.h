#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/messages.h"
#include "core/navigation_goal.h"
#include "core/route.h"
#include "core/settings.h"
#include "inspect/navigation_feedback.h"

namespace patrol::inspect {

struct TourSettings {
  int navigations = 10;           ///< times that the goals are driven to, each from a restart of the localisation
  bool starts_docked = true;      ///< otherwise the robot does not know where it is, and localises from scratch
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

/// What the docking says.
enum class DockingFeedback { kUnderWay, kDone, kFailed };

/// What the instruments' work at a place says (app/stack/tunnel_inspection.h).
enum class InspectionFeedback { kUnderWay, kDone, kFailed };

/// What the robot shall do now: stand, follow the remote control, drive to the goal, leave the dock, dock, scan the lining, sound for
/// water.
enum class TourMode { kStand, kRemote, kNavigate, kUndock, kDock, kScan, kSound };

struct TourInput {
  PoseEstimate pose;
  bool is_lost = false;
  NavigationFeedback navigation = NavigationFeedback::kDriving;
  DockingFeedback docking = DockingFeedback::kUnderWay;
  InspectionFeedback inspection = InspectionFeedback::kUnderWay;
  std::optional<RemoteCommand> remote;  ///< that came since the last step
};

struct TourOutput {
  TourMode mode = TourMode::kStand;
  std::optional<NavigationGoal> goal;  ///< with kNavigate
  std::string station;                 ///< with kScan and kSound: what the result is filed under
  bool map_is_made = false;            ///< now: the mapping drive is over
  bool localize_anew = false;          ///< now: forget where the robot is, start again from what is known of the start
  std::vector<Event> events;           ///< that happened now
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
class Tour {
 public:
  /// `goals` in map; empty: they are marked on the way. Without a map the remote control comes first, to make one; with a map, only at
  /// goals of type R. Throws InputError when there is neither a goal nor a remote control.
  Tour(const TourSettings& settings, std::vector<MarkedGoal> goals, bool has_remote, bool has_map = false);

  TourOutput step(Time now, const TourInput& input);

  bool is_over() const { return phase_ == Phase::kOver; }
  const std::vector<MarkedGoal>& goals() const { return goals_; }
  /// Ends the tour with an event of this kind, unless it is over.
  Event abort(Time now, EventKind kind, const std::string& text);

 private:
  enum class Phase { kWaiting, kRemote, kUndocking, kDriving, kStanding, kScanning, kHandedOver, kSounding, kDocking, kOver };

  void wait(TourOutput& output);
  void follow_remote(const TourInput& input, TourOutput& output);
  void undock(const TourInput& input);
  void drive(const TourInput& input, TourOutput& output);
  void stand(TourOutput& output);
  void scan(const TourInput& input, TourOutput& output);
  void hand_over(const TourInput& input, TourOutput& output);
  void sound(const TourInput& input, TourOutput& output);
  void dock(const TourInput& input, TourOutput& output);
  bool watch_localization(const TourInput& input, TourOutput& output);
  void start_navigation(TourOutput& output);
  void next_goal(TourOutput& output);
  void end_navigation(TourOutput& output);
  void finish(TourOutput& output);
  void enter(Phase phase);
  Event event(EventKind kind, const std::string& subject, const std::string& text, double value = 0.0) const;
  std::string goal_name() const;
  std::string sounding_name() const;

  TourSettings settings_;
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

}  // namespace patrol::inspect
