#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/batch/result_store.h"
#include "app/sweep/manifest.h"

namespace patrol::app {

/// Results of a sweep's runs, in the manifest's order; none for what has not been run.
using SweepRows = std::vector<std::optional<RunVerdict>>;

SweepRows load_rows(const SweepManifest& manifest, const ResultStore& store);

/// One metric, [seed][variant]; none where a run did not give it.
std::vector<std::vector<std::optional<double>>> figures_of(const SweepManifest& manifest, const SweepRows& rows, const std::string& metric);

}  // namespace patrol::app
