#include "app/report/run_contents.h"

#include <fmt/format.h>

#include "core/error.h"
#include "io/files/atomic_file.h"
#include "io/maps/map_server.h"

namespace patrol::app {
namespace {

/// First line of the resolved scenario, without its '#'.
std::string comment_of(const std::filesystem::path& scenario) {
  const std::string text = io::load_text(scenario);
  return text.starts_with("# ") ? text.substr(2, text.find('\n') - 2) : "";
}

void read_junit(RunContents& run) {
  run.name = "run";
  if (!std::filesystem::exists(run.directory.junit())) return;
  const std::vector<io::JunitSuite> suites = io::load_junit(run.directory.junit());
  if (suites.empty()) return;
  run.name = suites.front().name;
  run.cases = suites.front().cases;
  for (const auto& [name, value] : suites.front().properties) {
    if (name == "version") run.version = value;
  }
}

/// Pose of map in world as scored; without a score, that of the replay.
Pose2 map_in_world(const RunContents& run) {
  const auto value = [&](const char* name) {
    return io::metric_at(run.metrics, fmt::format("map.origin_in_world.{}", name));
  };
  const auto x_m = value("x_m"), y_m = value("y_m"), yaw_rad = value("yaw_rad");
  if (x_m && y_m && yaw_rad) return {*x_m, *y_m, *yaw_rad};
  if (!overlap(run.record.T_map_body, run.record.T_world_body)) return {};
  return pose_of_map(run.record, std::nullopt);
}

}  // namespace

bool overlap(const Trajectory& estimate, const Trajectory& truth) {
  return !estimate.empty() && !truth.empty() && estimate.front().stamp <= truth.back().stamp;
}

RunContents read_run_contents(const std::filesystem::path& root) {
  RunContents run;
  run.directory = open_run_directory(root);
  run.scenario = load_scenario(run.directory.scenario());
  run.origin_comment = comment_of(run.directory.scenario());
  read_junit(run);
  run.record = read_run_record(run.directory.log());
  run.is_complete = run.directory.is_complete() && run.record.is_complete;
  if (std::filesystem::exists(run.directory.metrics())) run.metrics = io::load_metrics(run.directory.metrics());
  if (std::filesystem::exists(run.directory.truth_map())) run.truth_map = io::load_map(run.directory.truth_map());
  // A truncated log has an earlier map than the errors, or none.
  if (run.record.is_complete && std::filesystem::exists(run.directory.map_errors())) {
    run.map_errors_m = io::load_map_errors(run.directory.map_errors(), run.record.map.geometry());
  }
  run.T_world_map = map_in_world(run);
  return run;
}

}  // namespace patrol::app
