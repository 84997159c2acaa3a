#include "app/study/scan_navigation_study.h"

#include <limits>

#include <fmt/format.h>

#include "app/common/temporary_folder.h"
#include "app/record/run_directory.h"
#include "app/record/run_record.h"
#include "app/run/run_once.h"
#include "app/scoring/true_map.h"
#include "app/study/scan_world.h"
#include "importer/site/site_import.h"
#include "io/json/metrics_json.h"
#include "score/driven_clearance.h"

namespace patrol::app {
namespace {

/// Metric of the run with its factor to the unit of the study.
struct RunMetric {
  const char* path;
  double factor = 1.0;
  studies::StudyMetric metric{};
};

const std::vector<RunMetric>& run_metrics() {
  static const std::vector<RunMetric> metrics = {
      {"pose.site.ate_rmse_m", 100.0, {.name = "ATE", .unit = "cm", .is_compared = true}},
      {"mission.completed", 1.0, {.name = "completed", .unit = ""}},
      {"mission.collisions", 1.0, {.name = "collisions", .unit = ""}},
      {"mission.distance_m", 1.0, {.name = "distance", .unit = "m"}},
      {"performance.cpu_s", 1.0, {.name = "run", .unit = "s", .is_processor_time = true}}};
  return metrics;
}

std::vector<studies::StudyMetric> study_metrics() {
  std::vector<studies::StudyMetric> metrics = {{.name = "minimum clearance", .unit = "cm", .is_compared = true},
                                               {.name = "mean clearance", .unit = "cm", .is_compared = true}};
  for (const RunMetric& metric : run_metrics()) metrics.push_back(metric.metric);
  return metrics;
}

/// Runs the scenario. Returns the metrics of the run.
std::vector<double> navigate(const Scenario& scenario, const ScenarioFiles& files,
                             const std::filesystem::path& data_root, const std::filesystem::path& folder) {
  NullObserver observer;
  const std::optional<RunVerdict> verdict = run_once(scenario, files, "study", data_root, folder, observer);
  std::vector<double> figures;
  for (const RunMetric& metric : run_metrics()) {
    const std::optional<double> value = verdict ? io::metric_at(verdict->metrics, metric.path) : std::nullopt;
    figures.push_back(value ? metric.factor * *value : std::numeric_limits<double>::quiet_NaN());
  }
  return figures;
}

/// Returns minimum and mean clearance of a completed run from the surfaces of the world, cm.
std::vector<double> clearance_cm(const RunRecord& record, const ScenarioFiles& files, const TrueMap& world_map) {
  const score::DrivenClearance clearance =
      score::driven_clearance(record.T_world_body, files.robot.footprint_m, world_map.reference.cells);
  return {100.0 * clearance.min_m, 100.0 * clearance.mean_m};
}

/// Adds the runs in the world and in its site to the sample.
void compare_navigation(const ScannedWorld& world, std::uint64_t seed, studies::StudySample& sample) {
  const TemporaryFolder folder(fmt::format("scan-navigation-{}-{}", world.name, seed));
  const std::filesystem::path data_root = find_data_root("");
  Scenario scenario = load_scenario(data_root / world.scenario, {fmt::format("seed={}", seed)});
  scenario.actors.clear();  // they are bodies of the world
  ScenarioFiles files = load_scenario_files(scenario, data_root);
  const std::vector<double> in_world = navigate(scenario, files, data_root, folder.path() / "world_run");
  const RunRecord world_record = read_run_record(RunDirectory{folder.path() / "world_run"}.log());
  const TrueMap world_map = true_map(world_record, scenario, files);

  save_scans(world, seed, folder.path() / "scans");
  const std::string name = "scanned_" + world.name;
  const importer::ImportedSite site = importer::import_site({.file = folder.path() / "scans", .name = name});
  importer::write_site(site, folder.path() / name);
  files.world_xml = folder.path() / name / (name + ".xml");
  add_anchors(world, files.world_xml);
  files.site = {.ground = site.ground};
  const std::vector<double> in_site = navigate(scenario, files, data_root, folder.path() / "site_run");
  const auto add = [&](const RunRecord& record, const std::vector<double>& metrics) {
    std::vector<double>& row = sample.emplace_back(clearance_cm(record, files, world_map));
    row.insert(row.end(), metrics.begin(), metrics.end());
  };
  add(world_record, in_world);
  add(read_run_record(RunDirectory{folder.path() / "site_run"}.log()), in_site);
}

/// `world`: index in scanned_worlds().
studies::Study navigation_study(const std::string& name, std::size_t index) {
  const ScannedWorld& world = scanned_worlds()[index];
  studies::Study study{
      .name = name,
      .title = "Navigation in a site from panoramic scans",
      .source = "no publication; test of the import of sites",
      .conditions = fmt::format(
          "Each seed: {} without its actors in the world, and with the same mission, map and seed in the site of 12 "
          "panoramic scans, taken with that seed (study scan-import), with the UWB anchors of the world. The clearance "
          "of "
          "both runs is that from the surfaces of the world.",
          world.scenario),
      .default_seeds = 10,
      .compared_with = "the world"};
  study.metrics = study_metrics();
  study.variants.push_back({.world = world.name, .method = "world"});
  study.variants.push_back({.world = world.name, .method = "site of scans"});
  study.run = [&world](std::uint64_t seed) {
    studies::StudySample sample;
    compare_navigation(world, seed, sample);
    return sample;
  };
  study.illustrate = [](std::uint64_t) { return std::vector<report::Section>{}; };
  return study;
}

}  // namespace

studies::Study scan_navigation_study() { return navigation_study("scan-navigation", 0); }

studies::Study scan_navigation_substation_study() { return navigation_study("scan-navigation-substation", 1); }

}  // namespace patrol::app
