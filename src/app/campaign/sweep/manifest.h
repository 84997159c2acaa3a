#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "app/campaign/sweep/axis.h"

namespace patrol::app {

/// One run of a sweep.
struct PlannedRun {
  std::size_t variant = 0;
  std::uint64_t seed = 1;
  std::vector<std::string> overrides;  ///< overrides of the variant, then those sampled for the seed: "path=value"
  std::string hash;                    ///< content hash of the result (run_hash.h)
};

/// Condition for stopping before all seeds are run.
struct EarlyStop {
  bool is_early = false;
  double equivalence_margin = 0.0;  ///< in units of the first metric: smaller differences are treated as equal
};

/// Command of a sweep, which determines its variants. Budget: the first is the unchanged scenario, the last has every
/// error source removed. Fault matrix: the first has no fault.
enum class SweepKind { kSweep, kBudget, kFaults };

inline constexpr std::array kSweepKinds = std::to_array<NamedValue<SweepKind>>({
    {SweepKind::kSweep, "sweep", "Runs over settings and seeds"},
    {SweepKind::kBudget, "budget", "Error budget: runs without one error source each"},
    {SweepKind::kFaults, "faults", "Fault matrix: runs with one sensor fault each"},
});
static_assert(is_in_order(kSweepKinds));

/// Request of a sweep (sweep.json). Runs are independent of each other, so that several processes can divide them.
struct SweepManifest {
  SweepKind kind = SweepKind::kSweep;
  std::string scenario;                ///< file name of the scenario, for display
  std::vector<std::string> overrides;  ///< overrides of all runs
  std::vector<std::string> paths;      ///< keys that are varied or sampled
  std::vector<Variant> variants;       ///< all others are compared with the first
  std::vector<std::uint64_t> seeds;
  std::vector<std::string> metrics;  ///< metrics to compare
  EarlyStop stop;
  std::vector<PlannedRun> runs;  ///< ordered by seed, then by variant
};

/// All overrides of a run: the common ones, its own, and the seed.
std::vector<std::string> overrides_of(const SweepManifest& manifest, const PlannedRun& run);

void save_manifest(const std::filesystem::path& file, const SweepManifest& manifest);

/// Loads sweep.json. Throws InputError if it is missing or invalid.
SweepManifest load_manifest(const std::filesystem::path& file);

}  // namespace patrol::app
