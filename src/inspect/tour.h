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
  double stand_s = 1.0;           ///< at a goal, before it is reported
  double position_tol_m = 0.03;   ///< at a goal; never more than its own accuracy asks
  double yaw_tol_rad = 0.017;
  double remote_silence_s = 2.0;  ///< without a command the remote control counts as switched off
  double lost_patience_s = 30.0;  ///< standing still, not knowing where it is, before it says that it cannot tell

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("navigations", self.navigations, between(0, 1000));
    visit("starts_docked", self.starts_docked);
    visit("docks", self.docks);
    visit("start_wait_s", self.start_wait_s, between(0.0, 600.0));
    visit("stand_s", self.stand_s, between(0.0, 60.0));
    visit("position_tol_m", self.position_tol_m, between(0.005, 5.0));
    visit("yaw_tol_rad", self.yaw_tol_rad, between(0.002, 3.2));
    visit("remote_silence_s", self.remote_silence_s, between(0.2, 60.0));
    visit("lost_patience_s", self.lost_patience_s, between(1.0, 600.0));
  }
};

/// What the docking says.
enum class DockingFeedback { kUnderWay, kDone, kFailed };

/// What the robot shall do now.
enum class TourMode { kStand, kRemote, kNavigate, kUndock, kDock };

struct TourInput {
  PoseEstimate pose;
  bool is_lost = false;
  NavigationFeedback navigation = NavigationFeedback::kDriving;
  DockingFeedback docking = DockingFeedback::kUnderWay;
  std::optional<RemoteCommand> remote;  ///< that came since the last step
};

struct TourOutput {
  TourMode mode = TourMode::kStand;
  std::optional<NavigationGoal> goal;  ///< with kNavigate
  bool map_is_made = false;            ///< now: the mapping drive is over
  bool localize_anew = false;          ///< now: forget where the robot is, start again from what is known of the start
  std::vector<Event> events;           ///< that happened now
};

/// Paper 004's experiment (section 4.2): a drive by remote control makes the map and marks the goals; then, again and again, the robot
/// restarts at its post, drives to every goal, stands there, and comes back. Without a remote control the map and the goals are given.
///
/// Events: goal_marked, mapping_done, navigation_started, goal_reached, goal_failed, docked, dock_failed, lost, relocalized,
/// cannot_localize, mission_completed (every goal of every navigation reached, every docking done), mission_failed. Subjects are "goal_2",
/// "navigation_7"; a goal's value is the number of its navigation.
class Tour {
 public:
  /// `goals` in map; empty: they are marked on the way. Throws InputError when there is neither a goal nor a remote control.
  Tour(const TourSettings& settings, std::vector<MarkedGoal> goals, bool has_remote);

  TourOutput step(Time now, const TourInput& input);

  bool is_over() const { return phase_ == Phase::kOver; }
  const std::vector<MarkedGoal>& goals() const { return goals_; }
  /// Ends the tour with an event of this kind, unless it is over.
  Event abort(Time now, const std::string& kind, const std::string& text);

 private:
  enum class Phase { kWaiting, kRemote, kUndocking, kDriving, kStanding, kDocking, kOver };

  void wait(TourOutput& output);
  void follow_remote(const TourInput& input, TourOutput& output);
  void undock(const TourInput& input);
  void drive(const TourInput& input, TourOutput& output);
  void stand(TourOutput& output);
  void dock(const TourInput& input, TourOutput& output);
  bool watch_localization(const TourInput& input, TourOutput& output);
  void start_navigation(TourOutput& output);
  void next_goal(TourOutput& output);
  void end_navigation(TourOutput& output);
  void finish(TourOutput& output);
  void enter(Phase phase);
  Event event(const std::string& kind, const std::string& subject, const std::string& text, double value = 0.0) const;
  std::string goal_name() const;

  TourSettings settings_;
  std::vector<MarkedGoal> goals_;
  bool has_remote_;
  bool is_docked_;
  Phase phase_ = Phase::kWaiting;
  Time phase_start_{};
  Time last_remote_{};
  int navigation_ = 0;        ///< 1 is the first
  std::size_t goal_ = 0;
  int num_failed_ = 0;
  std::optional<Time> lost_since_;
  Time now_{};
  Pose2 T_map_body_;
};

}  // namespace patrol::inspect
