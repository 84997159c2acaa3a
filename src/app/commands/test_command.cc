#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "app/campaign/batch/result_store.h"
#include "app/campaign/batch/run_batch.h"
#include "app/campaign/test/tested_scenario.h"
#include "app/commands/commands.h"
#include "app/common/output_directory.h"
#include "app/common/print_result.h"
#include "app/common/text_style.h"
#include "app/report/test_page.h"
#include "core/error.h"
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

std::string to_text(const std::vector<TestedScenario>& tested, TextStyle style) {
  std::string text;
  for (const TestedScenario& one : tested) {
    const RunVerdict& verdict = *one.verdict;
    const bool has_passed = verdict.code() == ExitCode::kDone;
    const std::string status = fmt::format("{:<20}", has_passed ? "passed" : name_of(verdict.end));
    text += fmt::format("{} {}  {}\n", colored(status, has_passed, style), one.name, verdict.message);
  }
  return text;
}

io::Metrics to_json(const std::vector<TestedScenario>& tested) {
  io::Metrics scenarios = io::Metrics::array();
  for (const TestedScenario& one : tested) {
    io::Metrics& json = scenarios.emplace_back(io::Metrics{{"name", one.name}, {"file", one.file.generic_string()}});
    json.update(to_json(*one.verdict));
  }
  return scenarios;
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
  if (!seeds.is_empty() &&
      std::ranges::none_of(tested, [&](const auto& one) { return seeds.seed_of(one.file).has_value(); }))
    throw InputError(fmt::format("{}: names none of the scenarios: a key must be the end of the path of a scenario",
                                 options.seed_table.string()));
  require_own_stacks(runs_of(tested), settings);
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

  const std::filesystem::path junit = out / "junit.xml";
  print_result(options.form,
               to_text(tested, output_style()) + fmt::format("{} scenarios: {}\n", tested.size(), junit.string()),
               {{"scenarios", to_json(tested)}, {"junit", junit.string()}});
  return worst;
}

}  // namespace patrol::app
