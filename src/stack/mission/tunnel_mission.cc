#include "stack/mission/tunnel_mission.h"

#include <algorithm>
#include <numbers>

#include <fmt/format.h>

#include "core/text.h"

namespace patrol::stack {

GoalType TunnelMissionSettings::goal_type(std::size_t index) const {
  if (index >= goal_types.size()) return GoalType::kStop;
  if (const auto* row = find_named(kGoalTypes, std::string_view(goal_types).substr(index, 1))) return row->value;
  throw InputError(fmt::format("stack.tunnel_mission.goal_types = {}: must consist of the letters {}", goal_types,
                               join(names_of(kGoalTypes), ", ")));
}

TunnelMission::TunnelMission(const TunnelMissionSettings& settings, std::vector<SavedGoal> goals, bool has_teleop,
                             bool has_map)
    : settings_(settings),
      goals_(std::move(goals)),
      has_teleop_(has_teleop),
      has_map_(has_map),
      is_docked_(settings.start_docked && !settings.start_at_survey),
      localization_(settings.relocalization_timeout_s) {
  validate(settings, "stack.tunnel_mission");
  for (std::size_t i = 0; i < settings.goal_types.size(); ++i) settings.goal_type(i);
  if (goals_.empty() && !has_teleop)
    throw InputError("stack.tunnel_mission: requires goals or teleoperation to save them");
}

MissionOutput TunnelMission::step(Time now, const MissionInput& input) {
  now_ = now;
  if (!first_step_) first_step_ = now;
  T_map_body_ = input.pose.T_map_body;
  MissionOutput output;
  if (monitor_localization(input, output)) return output;
  switch (phase_) {
    case Phase::kWaiting:
      wait(input, output);
      break;
    case Phase::kTeleop:
      teleoperate(input, output);
      break;
    case Phase::kUndocking:
      undock(input, output);
      break;
    case Phase::kDriving:
      drive(input, output);
      break;
    case Phase::kStanding:
      stand(output);
      break;
    case Phase::kScanning:
      scan(input, output);
      break;
    case Phase::kTeleopAtGoal:
      await_teleop(input, output);
      break;
    case Phase::kSounding:
      sound(input, output);
      break;
    case Phase::kDocking:
      dock(input, output);
      break;
    case Phase::kOver:
      break;
  }
  output.task = task();
  return output;
}

Task TunnelMission::task() const {
  Task task;
  if (phase_ == Phase::kTeleop || phase_ == Phase::kTeleopAtGoal) task.motion = Motion::kTeleop;
  if (phase_ == Phase::kUndocking) task.motion = Motion::kUndock;
  if (phase_ == Phase::kDocking) task.motion = Motion::kDock;
  if (phase_ == Phase::kScanning)
    task.inspection = InspectionOrder{.instrument = InstrumentKind::kLining, .station = goal_name()};
  if (phase_ == Phase::kSounding)
    task.inspection = InspectionOrder{.instrument = InstrumentKind::kWater, .station = sounding_name()};
  if (phase_ != Phase::kDriving) return task;
  const SavedGoal& goal = goals_[goal_];
  const bool stops = goal.type != GoalType::kVia;
  task.motion = Motion::kNavigate;
  task.goal = {.T_map_body = goal.T_map_body,
               .position_tolerance_m =
                   stops ? std::min(settings_.position_tolerance_m, goal.accuracy_m) : goal.accuracy_m,
               .yaw_tolerance_rad = stops ? settings_.yaw_tolerance_rad : std::numbers::pi};
  return task;
}

/// Returns whether the robot stands still because localization is lost.
bool TunnelMission::monitor_localization(const MissionInput& input, MissionOutput& output) {
  const bool needs_pose = phase_ == Phase::kDriving || phase_ == Phase::kStanding || phase_ == Phase::kDocking;
  const auto status = localization_.step(now_, input.is_lost && needs_pose, T_map_body_, output.events);
  if (status == LocalizationMonitor::Status::kFailed) {
    ++num_failed_;
    finish(output);
  }
  return status != LocalizationMonitor::Status::kUsable;
}

void TunnelMission::wait(const MissionInput& input, MissionOutput& output) {
  const Time first_scan_wait = *first_step_ + from_seconds(settings_.first_scan_wait_s);
  if (now_ < from_seconds(settings_.init_wait_s) || now_ < first_scan_wait || input.awaits_first_scan) return;
  if (!has_teleop_ || has_map_) return start_run(output);
  last_teleop_ = now_;
  enter(Phase::kTeleop);
}

void TunnelMission::teleoperate(const MissionInput& input, MissionOutput& output) {
  is_docked_ = false;
  if (input.teleop) last_teleop_ = now_;
  if (input.teleop && input.teleop->save_goal) {
    goals_.push_back({.number = static_cast<int>(goals_.size()) + 1,
                      .T_map_body = T_map_body_,
                      .type = settings_.goal_type(goals_.size())});
    saved_.push_back(now_);
    goal_ = goals_.size() - 1;
    output.events.push_back(event(EventKind::kGoalSaved, goal_name(), fmt::format("Saved {}.", goal_name())));
  }
  const bool is_off = now_ - last_teleop_ > from_seconds(settings_.teleop_timeout_s);
  if (!is_off && !(input.teleop && input.teleop->hand_over)) return;
  output.is_map_complete = true;
  output.events.push_back(
      event(EventKind::kMappingCompleted, "", fmt::format("Mapping completed: {} goals saved.", goals_.size())));
  end_run(output);
}

/// Ends the mission if the robot does not get free of the post: it must not turn there.
void TunnelMission::undock(const MissionInput& input, MissionOutput& output) {
  if (input.docking == DockingFeedback::kInProgress) return;
  is_docked_ = false;
  if (input.docking == DockingFeedback::kFailed) {
    ++num_failed_;
    output.events.push_back(event(EventKind::kDockFailed, "", "Undocking failed.", run_));
    return finish(output);
  }
  enter(Phase::kDriving);
}

void TunnelMission::drive(const MissionInput& input, MissionOutput& output) {
  if (now_ == phase_start_) return;  // the feedback is for the previous goal
  if (input.navigation == NavigationFeedback::kFailed) {
    ++num_failed_;
    output.events.push_back(
        event(EventKind::kGoalFailed, goal_name(), fmt::format("{} is unreachable.", goal_name()), run_));
    return next_goal(output);
  }
  if (input.navigation != NavigationFeedback::kArrived) return;
  if (goals_[goal_].type == GoalType::kVia) return next_goal(output);
  enter(Phase::kStanding);
}

void TunnelMission::stand(MissionOutput& output) {
  if (now_ - phase_start_ < from_seconds(settings_.dwell_s)) return;
  output.events.push_back(event(EventKind::kGoalReached, goal_name(), fmt::format("At {}.", goal_name()), run_));
  if (goals_[goal_].type == GoalType::kScan) return enter(Phase::kScanning);
  if (goals_[goal_].type != GoalType::kOperator || !has_teleop_ || !has_map_) return next_goal(output);
  output.events.push_back(event(EventKind::kTeleopRequested, goal_name(), "Waiting for teleoperation."));
  last_teleop_ = now_;
  enter(Phase::kTeleopAtGoal);
}

void TunnelMission::scan(const MissionInput& input, MissionOutput& output) {
  if (now_ == phase_start_ || input.inspection.feedback == InspectionFeedback::kInProgress) return;
  if (input.inspection.feedback == InspectionFeedback::kFailed) {
    ++num_failed_;
    output.events.push_back(event(EventKind::kInspectionFailed, goal_name(),
                                  fmt::format("Lining measurement failed at {}.", goal_name()), run_));
  }
  next_goal(output);
}

void TunnelMission::await_teleop(const MissionInput& input, MissionOutput& output) {
  if (input.teleop) last_teleop_ = now_;
  if (input.teleop && input.teleop->save_goal) {
    ++num_soundings_;
    return enter(Phase::kSounding);
  }
  const bool is_over = input.teleop && input.teleop->hand_over;
  if (!is_over && now_ - last_teleop_ <= from_seconds(settings_.operator_timeout_s)) return;
  if (!is_over) ++num_failed_;
  output.events.push_back(event(EventKind::kTeleopEnded, goal_name(),
                                is_over ? "Teleoperation ended: resuming autonomous mode."
                                        : "Teleoperation timeout: resuming autonomous mode."));
  next_goal(output);
}

void TunnelMission::sound(const MissionInput& input, MissionOutput& output) {
  if (input.teleop) last_teleop_ = now_;
  if (now_ == phase_start_ || input.inspection.feedback == InspectionFeedback::kInProgress) return;
  if (input.inspection.feedback == InspectionFeedback::kFailed) {
    ++num_failed_;
    output.events.push_back(event(EventKind::kInspectionFailed, sounding_name(), "TEM sounding failed.", run_));
  }
  enter(Phase::kTeleopAtGoal);
}

void TunnelMission::dock(const MissionInput& input, MissionOutput& output) {
  if (now_ == phase_start_ || input.docking == DockingFeedback::kInProgress) return;
  is_docked_ = input.docking == DockingFeedback::kDone;
  if (is_docked_) {
    output.events.push_back(event(EventKind::kDocked, "", "Docked at the charging post.", run_));
  } else {
    ++num_failed_;
    output.events.push_back(event(EventKind::kDockFailed, "", "Docking failed.", run_));
  }
  start_run(output);
}

void TunnelMission::start_run(MissionOutput& output) {
  if (run_ >= settings_.num_runs || goals_.empty()) return finish(output);
  ++run_;
  goal_ = 0;
  output.relocalization = relocalization();
  output.events.push_back(event(EventKind::kNavigationStarted, fmt::format("navigation_{}", run_),
                                fmt::format("Run {} of {}: {} goals.", run_, settings_.num_runs, goals_.size()), run_));
  enter(is_docked_ ? Phase::kUndocking : Phase::kDriving);
}

/// A robot that is not docked keeps its pose: that of the dock would be wrong.
Relocalization TunnelMission::relocalization() const {
  if (settings_.start_at_survey) return Relocalization::kNone;
  if (!settings_.start_docked) return Relocalization::kAnywhere;
  return is_docked_ ? Relocalization::kAtDock : Relocalization::kNone;
}

void TunnelMission::next_goal(MissionOutput& output) {
  ++goal_;
  if (goal_ < goals_.size()) return enter(Phase::kDriving);
  end_run(output);
}

void TunnelMission::end_run(MissionOutput& output) {
  if (settings_.dock_after_run) return enter(Phase::kDocking);
  start_run(output);
}

void TunnelMission::finish(MissionOutput& output) {
  enter(Phase::kOver);
  if (num_failed_ == 0) {
    output.events.push_back(
        event(EventKind::kMissionCompleted, "", goals_.empty() ? "No goals were saved." : "Every goal was reached."));
    return;
  }
  output.events.push_back(event(EventKind::kMissionFailed, "", fmt::format("Tasks failed: {}.", num_failed_)));
}

std::vector<Event> TunnelMission::correct_map(Time now, const localize::MapCorrection& correction) {
  std::vector<Event> events;
  for (std::size_t i = 0; i < saved_.size(); ++i) {
    Pose2& T_map_goal = goals_[i].T_map_body;
    T_map_goal = correction.at(saved_[i]) * T_map_goal;
    events.push_back({.stamp = now,
                      .kind = EventKind::kGoalMoved,
                      .subject = goals_[i].name(),
                      .text = fmt::format("Moved goal_{} with the map.", goals_[i].number),
                      .T_map_body = T_map_goal,
                      .p_map_target = T_map_goal.position()});
  }
  return events;
}

Event TunnelMission::abort(Time now, EventKind kind, const std::string& text) {
  now_ = now;
  phase_ = Phase::kOver;
  return event(kind, goal_ < goals_.size() ? goal_name() : "", text);
}

void TunnelMission::enter(Phase phase) {
  phase_ = phase;
  phase_start_ = now_;
}

Event TunnelMission::event(EventKind kind, const std::string& subject, const std::string& text, double value) const {
  return {.stamp = now_,
          .kind = kind,
          .subject = subject,
          .text = text,
          .value = value,
          .T_map_body = T_map_body_,
          .p_map_target = T_map_body_.position()};
}

std::string TunnelMission::sounding_name() const { return fmt::format("sounding_{}", num_soundings_); }

std::string TunnelMission::goal_name() const { return goals_[goal_].name(); }

}  // namespace patrol::stack
