#include <cmath>
#include <map>
#include <numbers>
#include <string>

#include "app/scoring/score_run.h"
#include "core/geometry/angles.h"
#include "io/files/csv.h"
#include "io/files/teleop_csv.h"
#include "io/json/nav_json.h"
#include "io/json/registration_json.h"
#include "io/maps/map_server.h"
#include "io/trajectories/tum.h"

namespace patrol::app {
namespace {

void save_trajectories(const RunDirectory& directory, const RunRecord& record) {
  io::save_tum(directory.estimate(), record.T_map_body, "base_link in map, estimated by the stack");
  io::save_tum(directory.truth(), record.T_world_body, "base_link in world, ground truth");
  io::save_tum(directory.odometry(), record.T_odom_body, "base_link in odom, odometry only");
}

/// Saves the commands of a teleoperated drive, for repetition, and the goals that were saved.
void save_drive(const RunDirectory& directory, const Scenario& scenario, const RunRecord& record) {
  if (record.teleop.empty()) return;
  io::save_teleop(directory.teleop(), record.teleop);
  std::vector<SavedGoal> goals;
  std::map<std::string, std::size_t> index_of;  // by subject
  for (const Event& event : record.events) {
    if (event.kind == EventKind::kGoalMoved && index_of.contains(event.subject))
      goals[index_of[event.subject]].T_map_body = event.T_map_body;
    if (event.kind != EventKind::kGoalSaved) continue;
    index_of[event.subject] = goals.size();
    goals.push_back({.number = static_cast<int>(goals.size()) + 1,
                     .T_map_body = event.T_map_body,
                     .type = scenario.stack.tunnel_mission.goal_type(goals.size())});
  }
  if (!goals.empty()) io::save_nav(directory.nav(), goals);
}

/// Saves one row per sample: s, m, degrees in world.
void save_localizability(const std::filesystem::path& file_csv,
                         const std::vector<score::TrackedLocalizability>& track) {
  io::Table table{.name = "localizability",
                  .columns = {"time_s", "x_m", "y_m", "weak_std_m", "weak_direction_deg", "strong_std_m",
                              "claimed_std_m", "claimed_direction_deg", "trust"},
                  .rows = {}};
  for (const score::TrackedLocalizability& at : track) {
    const score::LocalizabilitySample& sample = at.sample;
    const double claimed_deg = kDegPerRad * std::remainder(sample.reported_direction_rad, std::numbers::pi);
    table.rows.push_back({to_seconds(at.stamp), at.p_world_m.x(), at.p_world_m.y(), sample.truth.max_std_m,
                          kDegPerRad * sample.truth.max_std_direction_rad, sample.truth.min_std_m,
                          sample.reported_std_m, claimed_deg,
                          sample.confidence ? io::TableValue{*sample.confidence} : io::TableValue{}});
  }
  io::save_csv(file_csv, table);
}

}  // namespace

void save_scored_run(const RunDirectory& directory, const ScoredRun& run, const Scenario& scenario) {
  if (!run.score.estimate) return;
  save_trajectories(directory, run.record);
  save_drive(directory, scenario, run.record);
  if (!run.scans.empty()) io::save_station_scans(directory.scans(), run.scans);
  if (run.record.has_map()) io::save_map(directory.map(), run.record.map);
  if (!run.record.registrations.empty())
    io::save_registration(directory.registration(), run.record.registrations.back());
  io::save_map(directory.truth_map(), score::observable_part(run.truth->reference));
  if (run.record.has_map() && run.score.estimate->map)
    io::save_map_errors(directory.map_errors(), run.score.estimate->map->cells_m);
  save_localizability(directory.localizability(), run.score.estimate->localizability);
}

}  // namespace patrol::app
