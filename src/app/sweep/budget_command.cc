#include <fmt/format.h>

#include "app/commands.h"
#include "app/sweep/budget.h"
#include "app/sweep/imperfections.h"
#include "app/sweep/run_address.h"
#include "app/sweep/run_sweep.h"
#include "core/error.h"
#include "io/csv.h"

namespace patrol::app {
namespace {

/// The scenario as it is, without each imperfection that it has, and without all.
SweepManifest plan_budget(const BudgetOptions& options) {
  SweepManifest manifest{.scenario = options.scenario.filename().string(),
                         .overrides = options.overrides,
                         .paths = {},
                         .variants = {{.name = "as it is", .overrides = {}}},
                         .seeds = parse_seeds(options.seeds),
                         .metrics = options.metrics,
                         .stop = {},
                         .runs = {}};
  RunAddresses addresses(find_data_root(options.scenario));
  const auto address = [&](const std::vector<std::string>& overrides, std::uint64_t seed) {
    return addresses.of(load_scenario(options.scenario, overrides_of(manifest, {.variant = 0, .seed = seed, .overrides = overrides, .address = ""})));
  };
  const std::string as_it_is = address({}, 1);
  Variant ideal{.name = "all ideal", .overrides = {}};
  for (const Imperfection& imperfection : imperfections()) {
    if (address(imperfection.overrides, 1) == as_it_is) continue;  // this scenario does not have it
    manifest.variants.push_back({.name = imperfection.name, .overrides = imperfection.overrides});
    ideal.overrides.insert(ideal.overrides.end(), imperfection.overrides.begin(), imperfection.overrides.end());
  }
  manifest.variants.push_back(ideal);
  for (const std::uint64_t seed : manifest.seeds) {
    for (std::size_t variant = 0; variant < manifest.variants.size(); ++variant) {
      const std::vector<std::string>& overrides = manifest.variants[variant].overrides;
      manifest.runs.push_back({.variant = variant, .seed = seed, .overrides = overrides, .address = address(overrides, seed)});
    }
  }
  return manifest;
}

}  // namespace

ExitCode budget_command(const BudgetOptions& options) {
  const BatchSettings settings{.pool = {.num_processes = parse_jobs(options.jobs), .limit_s = options.run_limit_s}, .keep = KeepRuns::kNone};
  if (!(options.run_limit_s > 0.0)) throw InputError("--run-limit-s: must be greater than 0");
  const SweepManifest manifest = plan_budget(options);
  if (manifest.seeds.size() < 2) throw InputError("--seeds: a budget needs two at least: one says nothing of the spread");
  const SweepDirectory directory = begin_sweep_directory(options.out, manifest);
  if (!run_sweep(options.scenario, manifest, directory, {}, settings)) {
    fmt::print(stderr, "patrol: interrupted; {} is incomplete, the same command goes on\n", directory.root.string());
    return ExitCode::kProgramFailed;
  }
  const SweepRows rows = load_rows(manifest, directory.store());
  std::vector<Budget> budgets;
  for (const std::string& metric : manifest.metrics) budgets.push_back(make_budget(manifest, rows, metric));
  io::save_csv(directory.budget_csv(), budget_table(budgets));
  const SweepProgress progress = progress_of(manifest, rows);
  complete_sweep_directory(directory, manifest, rows, progress);
  for (const Budget& budget : budgets) fmt::print("{}\n", budget_text(budget));
  fmt::print("{} runs: {}\n", progress.counted.size(), directory.budget_csv().string());
  return worst_of(rows, progress);
}

}  // namespace patrol::app
