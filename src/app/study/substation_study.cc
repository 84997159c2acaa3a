#include "app/study/substation_study.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/common/temporary_folder.h"
#include "app/study/mapped_run.h"
#include "app/study/study_run.h"
#include "report/boxes.h"
#include "score/map_error.h"
#include "score/pose/trajectory_error.h"

namespace patrol::app {
namespace {

/// The mapping on the robot is unused during teleoperation; one particle saves computation time.
const std::vector<std::string> kWithoutOwnMapping = {"stack.slam.rbpf.particles=1"};

struct LogMethod {
  std::string name;
  std::string method;  ///< slam.method
  std::vector<std::optional<double>> published{};
  report::SeriesColor color = report::SeriesColor::kEstimate;
};

constexpr double kMinute_s = 60.0, kGigabyte_mb = 1000.0;

const std::vector<LogMethod> kSubstationMethods = {
    {.name = "improved RBPF (submap_rbpf)",
     .method = "submap_rbpf",
     .published = {0.1522, std::log10(0.1522), 0.0707, {}, {}, {}, {}, {}, 43.93 * kMinute_s, 0.9 * kGigabyte_mb},
     .color = report::SeriesColor::kEstimate},
    {.name = "pose graph (graph)",
     .method = "graph",
     .published = {0.3491, std::log10(0.3491), {}, {}, {}, {}, {}, {}, 51.35 * kMinute_s, 1.3 * kGigabyte_mb},
     .color = report::SeriesColor::kRanges},
    {.name = "plain RBPF (rbpf)",
     .method = "rbpf",
     .published = {2.7605, std::log10(2.7605), {}, {}, {}, {}, {}, {}, 21.01 * kMinute_s, 1.4 * kGigabyte_mb},
     .color = report::SeriesColor::kOdometry}};

const std::vector<studies::StudyMetric> kSubstationMetrics = {
    {.name = "map to nearest surface", .unit = "m", .is_compared = true},
    {.name = "its logarithm to base 10", .unit = "", .is_compared = true},
    {.name = "variance of that", .unit = "m^2", .is_compared = true},
    {.name = "95 % of it below", .unit = "m"},
    {.name = "pose RMSE", .unit = "m"},
    {.name = "loop closures", .unit = ""},
    {.name = "loop precision", .unit = ""},
    {.name = "loop recall", .unit = ""},
    {.name = "time", .unit = "s", .is_compared = true, .is_processor_time = true},
    {.name = "memory", .unit = "MB", .is_compared = true, .is_processor_time = true}};

StudyRun drive(const char* scenario, std::uint64_t seed, const TemporaryFolder& folder) {
  return run_for_study(scenario, kWithoutOwnMapping, seed, folder.path());
}

constexpr const char* kPatrol = "worlds/substation/scenarios/mapping.yaml";
constexpr const char* kRow = "worlds/substation/scenarios/row.yaml";

std::vector<double> flatten_metrics(const MappedRun& mapped, const StudyRun& run) {
  const Pose2 T_world_map = score::align_at_start(mapped.T_map_body, run.record.T_world_body);
  const score::MapError error = score::map_error(mapped.map, T_world_map, run.truth.reference);
  return {error.nearest_mean_m,
          std::log10(error.nearest_mean_m),
          error.nearest_var_m2,
          error.nearest_p95_m,
          score::trajectory_error(mapped.T_map_body, T_world_map, run.record.T_world_body).ate_rmse_m,
          static_cast<double>(mapped.loops.right + mapped.loops.wrong),
          mapped.loops.precision(),
          mapped.loops.recall(),
          mapped.seconds,
          mapped.memory_mb};
}

studies::StudySample map_patrol(std::uint64_t seed) {
  const TemporaryFolder folder(fmt::format("study-{}", seed));
  const StudyRun run = drive(kPatrol, seed, folder);
  studies::StudySample sample;
  for (const LogMethod& method : kSubstationMethods)
    sample.push_back(flatten_metrics(map_log_of(run, method.method), run));
  return sample;
}

/// Distances of all map points to the nearest surface of the reference map, ascending.
std::vector<double> sorted_errors_m(const MappedRun& mapped, const StudyRun& run) {
  const Pose2 T_world_map = score::align_at_start(mapped.T_map_body, run.record.T_world_body);
  const Grid<float> cells = score::map_error(mapped.map, T_world_map, run.truth.reference).cells_m;
  std::vector<double> errors;
  for (const float error : cells.values()) {
    if (!std::isnan(error)) errors.push_back(error);
  }
  std::ranges::sort(errors);
  return errors;
}

/// Evenly spaced quantiles of the values, `count` of them, because a page need not contain every point.
std::vector<double> quantiles(const std::vector<double>& sorted, std::size_t count) {
  std::vector<double> chosen;
  for (std::size_t i = 0; i < count && !sorted.empty(); ++i)
    chosen.push_back(sorted[i * (sorted.size() - 1) / (count - 1)]);
  return chosen;
}

/// Figure 6, then the maps.
std::vector<report::Section> illustrate_patrol(std::uint64_t seed) {
  constexpr std::size_t kPoints = 401;
  const TemporaryFolder folder(fmt::format("study-{}", seed));
  const StudyRun run = drive(kPatrol, seed, folder);
  report::LinePlot curves{.title =
                              fmt::format("Distance of the map points to the true surfaces, sorted, seed {}", seed),
                          .unit = "m",
                          .axis = {.label = "% of the points", .max = 100.0},
                          .max = {},
                          .curves = {},
                          .marks = {},
                          .spans = {}};
  report::BoxPlot boxes{.caption = "Distance of the map points to the true surfaces", .unit = "m", .boxes = {}};
  std::vector<report::Section> maps;
  for (const LogMethod& method : kSubstationMethods) {
    const MappedRun mapped = map_log_of(run, method.method);
    const std::vector<double> errors = quantiles(sorted_errors_m(mapped, run), kPoints);
    report::Curve curve{.name = method.name, .color = method.color, .is_dashed = false, .points = {}};
    for (std::size_t i = 0; i < errors.size(); ++i)
      curve.points.emplace_back(100.0 * static_cast<double>(i) / (kPoints - 1), errors[i]);
    curves.curves.push_back(std::move(curve));
    boxes.boxes.push_back(report::box_of(method.name, errors, {.factor = 1.0, .name = "m"}));
    maps.push_back({method.name, {map_error_block(mapped.map, mapped.T_map_body, run)}});
  }
  std::vector<report::Section> sections = {{"Errors of the map's points (figure 6)", {curves, boxes}}};
  for (report::Section& map : maps) sections.push_back(std::move(map));
  return sections;
}

studies::StudySample map_row(std::uint64_t seed) {
  const TemporaryFolder folder(fmt::format("study-{}", seed));
  const StudyRun run = drive(kRow, seed, folder);
  studies::StudySample sample;
  for (const LogMethod& method : kSubstationMethods) {
    const MappedRun mapped = map_log_of(run, method.method);
    const Pose2 T_world_map = score::align_at_start(mapped.T_map_body, run.record.T_world_body);
    sample.push_back({static_cast<double>(mapped.loops.wrong), static_cast<double>(mapped.loops.right),
                      score::trajectory_error(mapped.T_map_body, T_world_map, run.record.T_world_body).ate_rmse_m});
  }
  return sample;
}

std::vector<report::Section> illustrate_row(std::uint64_t seed) {
  const TemporaryFolder folder(fmt::format("study-{}", seed));
  const StudyRun run = drive(kRow, seed, folder);
  std::vector<report::Section> maps;
  for (const LogMethod& method : kSubstationMethods) {
    const MappedRun mapped = map_log_of(run, method.method);
    maps.push_back({method.name, {map_error_block(mapped.map, mapped.T_map_body, run)}});
  }
  return maps;
}

}  // namespace

studies::Study substation_study() {
  studies::Study study{
      .name = "substation",
      .title = "Mapping of the substation with three methods",
      .source = "[Yu23], tables 1 and 2, figure 6",
      .conditions =
          "Each seed is one simulated patrol of 923 m (worlds/substation/scenarios/mapping.yaml, lidar of "
          "[Yu23]), whose log is mapped by all methods with their default settings. The error of the plain "
          "filter varies tenfold between seeds, so that logarithms are compared too. Distances: from every "
          "occupied cell of the built map to the nearest surface, map and world aligned at the start. The "
          "published values are of another substation, robot and computer, and of one drive of 964 m; the "
          "published memory is that of the process, here that of the heap. A loop closure is right within 0.3 m "
          "and 0.05 rad. Recall: fraction of the nodes within 5 m of an older node that have a right closure.",
      .default_seeds = 5,
      .compared_with = "plain RBPF"};
  study.metrics = kSubstationMetrics;
  for (const LogMethod& method : kSubstationMethods) {
    study.variants.push_back({.world = "substation",
                              .method = method.name,
                              .particles = 0,
                              .reference = kSubstationMethods.size() - 1,
                              .published = method.published});
  }
  study.run = map_patrol;
  study.illustrate = illustrate_patrol;
  return study;
}

studies::Study row_study() {
  studies::Study study{
      .name = "substation-row",
      .title = "False loop closures among six identical bays",
      .source = "no publication; test of loop closures",
      .conditions =
          "Each seed is one drive along the bays (worlds/substation/scenarios/row.yaml) without revisits. A "
          "closure between poses that observe the same surfaces is right within 0.3 m and 0.05 rad; the bays "
          "are 15 m apart.",
      .default_seeds = 10,
      .compared_with = "plain RBPF"};
  study.metrics = {{.name = "false closures", .unit = ""},
                   {.name = "right closures", .unit = ""},
                   {.name = "pose RMSE", .unit = "m", .is_compared = true}};
  for (const LogMethod& method : kSubstationMethods)
    study.variants.push_back(
        {.world = "row", .method = method.name, .particles = 0, .reference = kSubstationMethods.size() - 1});
  study.run = map_row;
  study.illustrate = illustrate_row;
  return study;
}

}  // namespace patrol::app
