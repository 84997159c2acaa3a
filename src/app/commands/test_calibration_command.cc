#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <system_error>

#include <fmt/format.h>

#include "app/campaign/batch/result_store.h"
#include "app/campaign/batch/run_batch.h"
#include "app/campaign/sweep/sweep_options.h"
#include "app/campaign/test/calibration.h"
#include "app/campaign/test/expect_editor.h"
#include "app/campaign/test/limit_rules.h"
#include "app/campaign/test/tested_scenario.h"
#include "app/commands/commands.h"
#include "app/common/output_directory.h"
#include "app/scenario/data_folders.h"
#include "app/scenario/run_hash.h"
#include "app/scenario/scenario.h"
#include "core/error.h"
#include "io/files/atomic_file.h"
#include "io/files/csv.h"
#include "io/json/table_json.h"

namespace patrol::app {
namespace {

const OutputKind kCalibration = {.name = "calibration",
                                 .marker_text = "Incomplete: repeat the command to continue.",
                                 .outputs = {"calibration.csv", "expect.yaml"},
                                 .required_file = "calibration.csv",
                                 .preserved = {"runs", "work"}};

/// Scenario with its runs in the order of the seeds.
struct PlannedScenario {
  std::string name;
  std::filesystem::path file;
  io::Expectations present;
  std::vector<BatchRun> runs;
};

/// Content hash of a run. The expectations do not determine its metrics: a scenario that differs in them only has the
/// same results.
std::string hash_of(RunHasher& hasher, Scenario scenario) {
  scenario.expect.clear();
  return hasher.hash(scenario);
}

std::vector<PlannedScenario> plan_calibration(const TestOptions& options, const std::vector<std::uint64_t>& seeds) {
  std::vector<PlannedScenario> planned;
  for (const TestedScenario& tested : find_scenarios(options.scenarios, options.overrides)) {
    PlannedScenario& one = planned.emplace_back();
    one.name = tested.name;
    one.file = tested.file;
    one.present = load_scenario(tested.file, tested.overrides).expect;
    if (options.write)  // a section that cannot be edited is reported before the runs
      edit_expect_section(tested.file.string(), io::load_text(tested.file), one.present, {});
    RunHasher hasher(find_data_root(tested.file));
    for (const std::uint64_t seed : seeds) {
      std::vector<std::string> overrides = tested.overrides;
      overrides.push_back(fmt::format("seed={}", seed));
      one.runs.push_back({.scenario = tested.file,
                          .overrides = overrides,
                          .key = hash_of(hasher, load_scenario(tested.file, overrides)),
                          .label = fmt::format("{}, seed {}", tested.name, seed)});
    }
  }
  return planned;
}

/// Runs without a result, each once. Removes results that are failures of a stack in another process.
std::vector<BatchRun> missing_runs(const std::vector<PlannedScenario>& planned, const ResultStore& store) {
  std::vector<BatchRun> missing;
  std::set<std::string> keys;
  for (const PlannedScenario& one : planned) {
    for (const BatchRun& run : one.runs) {
      store.remove_stack_failure(run.key);
      if (!store.has(run.key) && keys.insert(run.key).second) missing.push_back(run);
    }
  }
  return missing;
}

/// A missed expectation of the stored run may be one of an earlier version of the file: only other ends count here.
ExitCode code_of(const Calibration& calibration, const std::vector<SeedRun>& runs) {
  ExitCode worst = ExitCode::kDone;
  for (const SeedRun& run : runs) {
    if (run.verdict.end != RunStatus::kExpectationMissed) worst = worse(worst, run.verdict.code());
  }
  const auto is_missed = [](const CalibratedMetric& metric) { return metric.is_missed(); };
  const bool is_met =
      calibration.failures.empty() && std::none_of(calibration.metrics.begin(), calibration.metrics.end(), is_missed);
  return is_met ? worst : worse(worst, ExitCode::kExpectationMissed);
}

/// Removes a file at the end of its scope.
struct FileRemover {
  std::filesystem::path file;

  ~FileRemover() {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
  }
};

/// Writes the proposals to the scenario. Throws std::runtime_error, and leaves the file, if the edited text would be
/// another scenario.
void write_expectations(const PlannedScenario& planned, const Calibration& calibration, bool may_widen) {
  const io::Expectations wanted = expectations_of(calibration, may_widen);
  std::map<std::string, std::string> measured;
  for (const CalibratedMetric& metric : calibration.metrics) measured[metric.metric] = measured_range(metric);
  const std::string text = edit_expect_section(planned.file.string(), io::load_text(planned.file), wanted, measured);

  Scenario intended = load_scenario(planned.file);
  intended.expect = wanted;
  const FileRemover edited{planned.file.string() + ".part"};
  io::save_text(edited.file, text);
  if (to_yaml(load_scenario(edited.file)) != to_yaml(intended))
    throw std::runtime_error(fmt::format("{}: edited expectations do not read back", planned.file.string()));
  std::filesystem::rename(edited.file, planned.file);
}

void check(const TestOptions& options) {
  if (options.write && !options.overrides.empty())
    throw InputError("--write: not compatible with --set: the values are those of another scenario than the file's");
}

}  // namespace

ExitCode test_calibration_command(const TestOptions& options) {
  check(options);
  const std::vector<std::uint64_t> seeds = parse_seeds(*options.calibrate, "--calibrate");
  const BatchSettings settings = batch_settings(options.batch);
  const std::filesystem::path out = options.out.empty() ? "out/calibration" : options.out;
  const std::vector<PlannedScenario> planned = plan_calibration(options, seeds);
  if (planned.empty()) {
    fmt::print(stderr, "patrol: {}: contains no scenario (*.yaml); nothing executed\n",
               options.scenarios.front().string());
    return ExitCode::kNothingExecuted;
  }
  for (const PlannedScenario& one : planned) require_own_stacks(one.runs, settings);
  const OutputLock lock = begin_output(out, kCalibration);
  const ResultStore store(runs_folder(out));
  if (!run_batch(missing_runs(planned, store), settings, out))
    throw std::runtime_error(fmt::format("interrupted; repeat the command to continue in {}", out.string()));

  ExitCode worst = ExitCode::kDone;
  std::vector<Calibration> calibrations;
  std::string text, sections;
  for (const PlannedScenario& one : planned) {
    std::vector<SeedRun> runs;
    for (std::size_t i = 0; i < seeds.size(); ++i)
      runs.push_back({.seed = seeds[i], .verdict = store.load(one.runs[i].key).value()});
    const Calibration& calibration = calibrations.emplace_back(calibrate(one.name, one.present, runs));
    worst = worse(worst, code_of(calibration, runs));
    sections += fmt::format("# {}\n{}\n", one.file.generic_string(), expect_section(calibration, options.widen));
    text += calibration_text(calibration) + "\n";
    if (!options.write) continue;
    if (calibration.failures.empty()) write_expectations(one, calibration, options.widen);
    else text += "  not written: not every seed completed the mission\n\n";
  }
  const io::Table table = calibration_table(calibrations);
  io::save_csv(out / "calibration.csv", table);
  io::save_text(out / "expect.yaml", sections);
  complete_output(out);
  if (!options.write) text += sections;
  print_result(options.form, text, io::to_json(table));
  return worst;
}

}  // namespace patrol::app
