#include <stdexcept>

#include <fmt/format.h>

#include "app/campaign/batch/result_store.h"
#include "app/campaign/batch/run_batch.h"
#include "app/campaign/test/tested_scenario.h"
#include "app/cli/commands.h"
#include "app/common/output_directory.h"
#include "app/report/test_page.h"
#include "io/files/atomic_file.h"
#include "io/files/csv.h"
#include "report/page.h"

namespace patrol::app {
namespace {

const OutputKind kTest = {.name = "test",
                          .marker_text = "Incomplete: not every scenario has ended.",
                          .outputs = {"junit.xml", "tests.csv", "summary.md", "report.html",
                                      "runs/[0-9][0-9][0-9][0-9]_*", "work/*-*-*", "*.part"},
                          .required_file = "junit.xml",
                          .preserved = {}};

std::vector<BatchRun> runs_of(const std::vector<TestedScenario>& tested) {
  std::vector<BatchRun> runs;
  for (const TestedScenario& one : tested) {
    runs.push_back({.scenario = one.file, .overrides = one.overrides, .key = one.key, .label = one.name});
  }
  return runs;
}

void print_verdicts(const std::vector<TestedScenario>& tested) {
  for (const TestedScenario& one : tested) {
    const RunVerdict& verdict = *one.verdict;
    fmt::print("{:<20} {}  {}\n", verdict.code() == ExitCode::kDone ? "passed" : name_of(verdict.end), one.name,
               verdict.message);
  }
}

}  // namespace

ExitCode test_command(const TestOptions& options) {
  if (options.calibrate) return test_calibration_command(options);
  const BatchSettings settings = batch_settings(options.batch);
  const SeedTable seeds = options.seed_table.empty() ? SeedTable() : SeedTable(options.seed_table);
  const std::filesystem::path out = options.out.empty() ? "out/test" : options.out;
  std::vector<TestedScenario> tested = find_scenarios(options.scenarios, options.overrides, seeds);
  if (tested.empty()) {
    fmt::print(stderr, "patrol: {}: contains no scenario (*.yaml); nothing executed\n",
               options.scenarios.front().string());
    return ExitCode::kNothingExecuted;
  }
  const OutputLock lock = begin_output(out, kTest);
  save_test_junit(out / "junit.xml", tested);

  const bool is_through = run_batch(runs_of(tested), settings, out);
  const ResultStore store(runs_folder(out));
  ExitCode worst = ExitCode::kDone;
  for (TestedScenario& one : tested) {
    one.verdict = store.load(one.key);
    if (one.verdict) worst = worse(worst, one.verdict->code());
  }
  save_test_junit(out / "junit.xml", tested);
  if (!is_through) throw std::runtime_error(fmt::format("interrupted; {} is incomplete", out.string()));
  io::save_csv(out / "tests.csv", tests_table(tested));
  io::save_text(out / "summary.md", tests_summary(tested));
  io::save_text(out / "report.html", report::to_html(test_page(tested)));
  complete_output(out);

  print_verdicts(tested);
  fmt::print("{} scenarios: {}\n", tested.size(), (out / "junit.xml").string());
  return worst;
}

}  // namespace patrol::app
