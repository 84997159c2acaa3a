#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

#include <fmt/format.h>

#include "app/batch/result_store.h"
#include "app/batch/run_batch.h"
#include "app/commands.h"
#include "app/sweep/sweep_options.h"
#include "app/test/tested_scenario.h"
#include "core/error.h"
#include "io/atomic_file.h"
#include "io/csv.h"

namespace patrol::app {
namespace {

constexpr std::array<std::string_view, 7> kOurFiles = {"junit.xml", "tests.csv", "summary.md", "summary.html", "runs", "work", "INCOMPLETE"};

/// Makes the folder, empty of an earlier test's results, and marks it incomplete.
void begin_test_directory(const std::filesystem::path& root) {
  std::error_code error;
  std::filesystem::create_directories(root, error);
  if (error) throw InputError(fmt::format("{}: cannot be made a directory: {}", root.string(), error.message()));
  for (const auto& entry : std::filesystem::directory_iterator(root)) {
    const std::string name = entry.path().filename().string();
    if (std::find(kOurFiles.begin(), kOurFiles.end(), name) == kOurFiles.end()) {
      throw InputError(fmt::format("{}: holds {}, which is not part of a test; name an empty or new directory", root.string(), name));
    }
  }
  for (const std::string_view name : kOurFiles) std::filesystem::remove_all(root / name, error);
  std::ofstream marker(root / "INCOMPLETE");
  marker << "Not every scenario has ended.\n";
  if (!marker.flush()) throw InputError(fmt::format("{}: cannot be written to", root.string()));
}

std::vector<BatchRun> runs_of(const std::vector<TestedScenario>& tested, const TestOptions& options) {
  std::vector<BatchRun> runs;
  for (const TestedScenario& one : tested) {
    runs.push_back({.scenario = one.file, .overrides = options.overrides, .address = one.address, .label = one.name});
  }
  return runs;
}

void print_verdicts(const std::vector<TestedScenario>& tested) {
  for (const TestedScenario& one : tested) {
    const RunVerdict& verdict = *one.verdict;
    fmt::print("{:<20} {}  {}\n", verdict.code == ExitCode::kDone ? "passed" : verdict.end, one.name, verdict.message);
  }
}

}  // namespace

ExitCode test_command(const TestOptions& options) {
  const BatchSettings settings{.pool = {.num_processes = parse_jobs(options.jobs), .limit_s = options.run_limit_s},
                               .keep = parse_keep(options.keep)};
  if (!(options.run_limit_s > 0.0)) throw InputError("--run-limit-s: must be greater than 0");
  std::vector<TestedScenario> tested = find_scenarios(options.scenarios, options.overrides);
  if (tested.empty()) {
    fmt::print(stderr, "patrol: {}: holds no scenario (*.yaml): nothing was executed\n", options.scenarios.string());
    return ExitCode::kNothingExecuted;
  }
  begin_test_directory(options.out);
  save_test_junit(options.out / "junit.xml", tested);

  const bool is_through = run_batch(runs_of(tested, options), settings, options.out);
  const ResultStore store(runs_folder(options.out));
  ExitCode worst = ExitCode::kDone;
  for (TestedScenario& one : tested) {
    one.verdict = store.load(one.address);
    if (one.verdict) worst = worse(worst, one.verdict->code);
  }
  save_test_junit(options.out / "junit.xml", tested);
  if (!is_through) {
    fmt::print(stderr, "patrol: interrupted; {} is incomplete\n", options.out.string());
    return ExitCode::kProgramFailed;
  }
  io::save_csv(options.out / "tests.csv", tests_table(tested));
  io::save_text(options.out / "summary.md", tests_summary(tested));
  std::filesystem::remove(options.out / "INCOMPLETE");

  print_verdicts(tested);
  fmt::print("{} scenarios: {}\n", tested.size(), (options.out / "junit.xml").string());
  return worst;
}

}  // namespace patrol::app
