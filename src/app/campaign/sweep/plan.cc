#include "app/campaign/sweep/plan.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "app/campaign/sweep/axis.h"
#include "app/campaign/sweep/error_sources.h"
#include "app/campaign/sweep/fault_matrix.h"
#include "app/scenario/data_folders.h"
#include "app/scenario/run_hash.h"
#include "app/scoring/expectations.h"
#include "app/scoring/metric_infos.h"
#include "app/scoring/metric_subjects.h"
#include "core/error.h"
#include "core/text.h"
#include "io/yaml/settings_yaml.h"

namespace patrol::app {
namespace {

/// Manifest with the parts common to all kinds; variants and runs follow.
template <typename Options>
SweepManifest begin_manifest(SweepKind kind, const Options& options) {
  for (const std::string& metric : options.metrics) check_metric(fmt::format("--metric {}: ", metric), metric);
  return {.kind = kind,
          .scenario = options.scenario.filename().string(),
          .overrides = options.overrides,
          .paths = {},
          .variants = {},
          .seeds = parse_seeds(options.seeds),
          .metrics = options.metrics,
          .stop = {},
          .runs = {}};
}

/// Loads the scenario of a run. In a sweep, an error in an override of the variant names --vary.
Scenario load_variant(const std::filesystem::path& scenario, const SweepManifest& manifest, const PlannedRun& run) {
  const std::vector<std::string> overrides = overrides_of(manifest, run);
  try {
    Scenario loaded = load_scenario(scenario, overrides);
    check_expected_metrics(loaded, {scenario.string(), overrides});
    return loaded;
  } catch (const InputError& error) {
    const std::string text = error.what();
    for (const std::string& override : run.overrides) {
      if (manifest.kind != SweepKind::kSweep) break;
      const std::string location = fmt::format("--set {}:", override);
      if (text.starts_with(location))
        throw InputError(fmt::format("--vary {}:{}", override, text.substr(location.size())));
    }
    throw;
  }
}

/// Throws InputError for a metric of a station or a parameter that no variant has. `variants`: their scenarios.
void check_subjects(const std::filesystem::path& scenario, const std::vector<std::string>& metrics,
                    const std::vector<Scenario>& variants) {
  for (const std::string& metric : metrics) {
    std::optional<InputError> refusal;
    for (const Scenario& variant : variants) {
      try {
        MetricSubjects(variant, scenario).check(fmt::format("--metric {}: ", metric), metric);
        refusal.reset();
        break;
      } catch (const InputError& error) {
        if (!refusal) refusal = error;
      }
    }
    if (refusal) throw InputError(*refusal);
  }
}

/// Adds the runs, ordered by seed, then by variant.
void plan_runs(const std::filesystem::path& scenario, const std::vector<Axis>& axes, SweepManifest& manifest) {
  RunHasher hasher(find_data_root(scenario));
  std::vector<Scenario> variants;  // of the first seed
  for (const std::uint64_t seed : manifest.seeds) {
    for (std::size_t variant = 0; variant < manifest.variants.size(); ++variant) {
      PlannedRun run{.variant = variant, .seed = seed, .overrides = manifest.variants[variant].overrides, .hash = ""};
      for (const Axis& axis : axes) {
        if (axis.is_random()) run.overrides.push_back(axis.sample(seed));
      }
      Scenario loaded = load_variant(scenario, manifest, run);
      run.hash = hasher.hash(loaded);
      manifest.runs.push_back(run);
      if (seed == manifest.seeds.front()) variants.push_back(std::move(loaded));
    }
    if (seed == manifest.seeds.front()) check_subjects(scenario, manifest.metrics, variants);
  }
}

/// Faults of the given names, all without names. Throws InputError for an unknown name.
std::vector<sim::FaultSettings> chosen_faults(const std::vector<sim::FaultSettings>& all,
                                              const std::vector<std::string>& names) {
  if (names.empty()) return all;
  std::vector<sim::FaultSettings> chosen;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(all, name, variant_name);
    if (found == all.end()) {
      std::vector<std::string> known;
      for (const sim::FaultSettings& fault : all) known.push_back(variant_name(fault));
      throw InputError(
          fmt::format("--fault {}: not in the matrix of this scenario: must be one of {}", name, join(known, ", ")));
    }
    chosen.push_back(*found);
  }
  return chosen;
}

}  // namespace

SweepManifest plan_sweep(const SweepOptions& options) {
  std::vector<Axis> axes;
  for (const std::string& text : options.vary) {
    axes.push_back(parse_axis(text));
    if (axes.back().path == "seed") throw InputError(fmt::format("--vary {}: seeds are varied with --seeds", text));
  }
  SweepManifest manifest = begin_manifest(SweepKind::kSweep, options);
  manifest.variants = cartesian_product(axes);
  manifest.stop = {.is_early = options.early_stop, .equivalence_margin = options.equivalence_margin};
  for (const Axis& axis : axes) manifest.paths.push_back(axis.path);
  plan_runs(options.scenario, axes, manifest);
  return manifest;
}

SweepManifest plan_error_budget(const ErrorBudgetOptions& options) {
  SweepManifest manifest = begin_manifest(SweepKind::kBudget, options);
  manifest.variants.push_back({.name = "baseline", .overrides = {}});
  if (manifest.seeds.size() < 2) throw InputError("--seeds: an error budget needs at least two seeds");
  const Scenario scenario = load_scenario(options.scenario, options.overrides);
  const ScenarioFiles files = load_scenario_files(scenario, find_data_root(options.scenario));
  const auto changes_it = [&](const ScenarioErrorSource& source) {
    std::vector<std::string> overrides = options.overrides;
    overrides.insert(overrides.end(), source.overrides.begin(), source.overrides.end());
    return to_yaml(load_scenario(options.scenario, overrides)) != to_yaml(scenario);
  };
  Variant ideal{.name = "all ideal", .overrides = {}};
  for (const ScenarioErrorSource& source : scenario_error_sources()) {
    if (!source.applies(scenario, files) || !changes_it(source)) continue;
    manifest.variants.push_back({.name = source.name, .overrides = source.overrides});
    ideal.overrides.insert(ideal.overrides.end(), source.overrides.begin(), source.overrides.end());
  }
  manifest.variants.push_back(ideal);
  plan_runs(options.scenario, {}, manifest);
  return manifest;
}

SweepManifest plan_fault_matrix(const FaultMatrixOptions& options) {
  SweepManifest manifest = begin_manifest(SweepKind::kFaults, options);
  manifest.paths = {"faults"};
  manifest.variants.push_back({.name = "no fault", .overrides = {"faults=[]"}});
  const Scenario scenario = load_scenario(options.scenario, options.overrides);
  if (options.start_s >= scenario.time_limit_s)
    throw InputError(fmt::format("--start-s {}: must be below time_limit_s = {} of the scenario", options.start_s,
                                 scenario.time_limit_s));
  const ScenarioFiles files = load_scenario_files(scenario, find_data_root(options.scenario));
  for (std::string& override : survival_overrides(scenario, {.max_error_m = options.max_error_m,
                                                            .min_map_coverage = options.min_map_coverage,
                                                            .max_lost_s = options.max_lost_s}))
    manifest.overrides.push_back(std::move(override));
  const std::vector<sim::FaultSettings> all = fault_matrix(scenario, files, options.start_s, options.duration_s);
  for (const sim::FaultSettings& fault : chosen_faults(all, options.faults))
    manifest.variants.push_back({.name = variant_name(fault), .overrides = {fault_override(fault)}});
  plan_runs(options.scenario, {}, manifest);
  return manifest;
}

}  // namespace patrol::app
