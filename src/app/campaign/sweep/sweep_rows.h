#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/campaign/batch/result_store.h"
#include "app/campaign/sweep/manifest.h"

namespace patrol::app {

/// Results of a sweep's runs, in the manifest's order; none for missing runs.
using SweepRows = std::vector<std::optional<RunVerdict>>;

SweepRows load_rows(const SweepManifest& manifest, const ResultStore& store);

/// Values of one metric, [seed][variant]; none for runs without it and for runs that failed.
std::vector<std::vector<std::optional<double>>> flatten_metrics(const SweepManifest& manifest, const SweepRows& rows,
                                                                const std::string& metric);

/// Number of runs of a variant that failed, of the first `num_seeds` seeds.
std::size_t count_failures(const SweepManifest& manifest, const SweepRows& rows, std::size_t variant,
                           std::size_t num_seeds);

}  // namespace patrol::app
