#pragma once

#include "app/campaign/sweep/comparison.h"
#include "report/blocks.h"

namespace patrol::app {

/// Short variant names for a page, [variant]: only the last part of each key ("range_noise_std_m=0.03"), if these are
/// unique.
std::vector<std::string> short_names(const SweepManifest& manifest);

/// Box plot of one metric by variant, differences from the first variant, and a table of both.
std::vector<report::Block> comparison_blocks(const SweepManifest& manifest, const SweepRows& rows,
                                             const SweepProgress& progress, const std::string& metric);

/// Table of how each run ended, incomplete runs first.
report::CollapsibleTables run_table(const SweepManifest& manifest, const SweepRows& rows,
                                    const SweepProgress& progress);

}  // namespace patrol::app
