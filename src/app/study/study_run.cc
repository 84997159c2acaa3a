#include "app/study/study_run.h"

#include <fmt/format.h>

#include "app/record/run_directory.h"
#include "app/run/run_once.h"
#include "app/scenario/data_folders.h"
#include "report/map_picture.h"
#include "score/map_error.h"
#include "score/pose/trajectory_error.h"

namespace patrol::app {
namespace {

std::vector<Eigen::Vector2d> positions_of(const Trajectory& trajectory, const Pose2& T_world_frame) {
  std::vector<Eigen::Vector2d> positions;
  for (const StampedPose& entry : trajectory) positions.push_back(T_world_frame * to_pose2(entry.pose).position());
  return positions;
}

}  // namespace

StudyRun run_for_study(const std::string& scenario, const std::vector<std::string>& overrides, std::uint64_t seed,
                       const std::filesystem::path& folder) {
  const std::filesystem::path data_root = find_data_root("");
  std::vector<std::string> all = overrides;
  all.push_back(fmt::format("seed={}", seed));
  StudyRun run{.scenario = load_scenario(data_root / scenario, all), .files = {}, .log = {}, .record = {}, .truth = {}};
  run.files = load_scenario_files(run.scenario, data_root);
  NullObserver observer;
  run_once(run.scenario, "study", data_root, folder, observer);
  run.log = RunDirectory{folder}.log();
  run.record = read_run_record(run.log);
  run.truth = true_map(run.record, run.scenario, run.files);
  return run;
}

report::MapBlock map_error_block(const OccupancyGrid& map, const Trajectory& T_map_body, const StudyRun& run) {
  const Pose2 T_world_map = score::align_at_start(T_map_body, run.record.T_world_body);
  const std::vector<report::MapPath> paths = {
      {"true path", report::SeriesColor::kTruth, {positions_of(run.record.T_world_body, {})}},
      {"estimated path", report::SeriesColor::kEstimate, {positions_of(T_map_body, T_world_map)}}};
  Eigen::AlignedBox2d shown;
  for (const Eigen::Vector2d& p_m : paths.front().pieces_m.front()) shown.extend(p_m);
  const report::MapLayers layers{.built = map,
                                 .T_world_map = T_world_map,
                                 .truth = score::observable_part(run.truth.reference),
                                 .error_m = score::map_error(map, T_world_map, run.truth.reference).cells_m};
  return {.picture = report::map_picture(layers, shown), .paths = paths, .marks = {}};
}

}  // namespace patrol::app
