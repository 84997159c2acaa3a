#pragma once

#include <string>

#include "app/sweep/comparison.h"
#include "app/sweep/manifest.h"
#include "io/table.h"

namespace patrol::app {

/// One row a counted run: variant, what was varied, seed, address, how it ended, and every figure but `performance`, which is another each time.
io::Table runs_table(const SweepManifest& manifest, const SweepRows& rows, const SweepProgress& progress);

/// One row for each compared metric and variant: mean, 95 % interval, paired difference to the first variant, verdict.
io::Table comparison_table(const SweepManifest& manifest, const SweepRows& rows, const SweepProgress& progress);

/// The comparison for a screen.
std::string comparison_text(const SweepManifest& manifest, const SweepRows& rows, const SweepProgress& progress);

}  // namespace patrol::app
