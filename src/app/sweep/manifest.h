#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "app/sweep/axis.h"

namespace patrol::app {

/// One run of a sweep.
struct PlannedRun {
  std::size_t variant = 0;
  std::uint64_t seed = 1;
  std::vector<std::string> overrides;  ///< the variant's, then what was drawn for the seed: "path=value"
  std::string address;                 ///< of its result (run_address.h)
};

/// When to leave off before all seeds are run.
struct EarlyStop {
  bool when_decided = false;
  double margin = 0.0;  ///< of the first metric: two variants closer than this are as good as equal
};

/// Which command made it, and what its variants are: of a budget the first is the scenario as it is, the last has every imperfection taken
/// away; of a fault matrix the first has no fault.
enum class SweepKind { kSweep, kBudget, kFaults };

inline constexpr std::array kSweepKinds = std::to_array<NamedValue<SweepKind>>({
    {SweepKind::kSweep, "sweep", "Runs over settings and seeds"},
    {SweepKind::kBudget, "budget", "Error budget: runs without one error source each"},
    {SweepKind::kFaults, "faults", "Fault matrix: runs with one sensor fault each"},
});
static_assert(is_in_order(kSweepKinds));

/// What a sweep was asked for: sweep.json. A run is independent of all others, so that any number of processes can share them out.
struct SweepManifest {
  SweepKind kind = SweepKind::kSweep;
  std::string scenario;                ///< its file's name, for people
  std::vector<std::string> overrides;  ///< common to all
  std::vector<std::string> paths;      ///< that are varied or drawn
  std::vector<Variant> variants;       ///< the others are compared with the first
  std::vector<std::uint64_t> seeds;
  std::vector<std::string> metrics;    ///< that are compared
  EarlyStop stop;
  std::vector<PlannedRun> runs;        ///< seed by seed, in each all variants
};

/// All of a run's: the common ones, its own, and the seed.
std::vector<std::string> overrides_of(const SweepManifest& manifest, const PlannedRun& run);

void save_manifest(const std::filesystem::path& file, const SweepManifest& manifest);

/// Throws InputError when there is none, or it is not one.
SweepManifest load_manifest(const std::filesystem::path& file);

}  // namespace patrol::app
