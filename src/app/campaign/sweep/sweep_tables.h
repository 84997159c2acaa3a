#pragma once

#include <string>

#include "app/campaign/sweep/comparison.h"
#include "app/campaign/sweep/manifest.h"
#include "io/files/table.h"

namespace patrol::app {

/// Table with one row per counted run: variant, varied keys, seed, content hash, status, and all metrics except
/// `performance`, which is not reproducible.
io::Table runs_table(const SweepManifest& manifest, const SweepRows& rows, const SweepProgress& progress);

/// Table with one row per compared metric and variant: numbers of runs, mean, 95 % interval, paired difference from the
/// first variant, verdict.
io::Table comparison_table(const SweepManifest& manifest, const SweepRows& rows, const SweepProgress& progress);

/// Comparison as text for a terminal.
std::string comparison_text(const SweepManifest& manifest, const SweepRows& rows, const SweepProgress& progress);

}  // namespace patrol::app
