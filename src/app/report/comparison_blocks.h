#pragma once

#include "app/sweep/comparison.h"
#include "render/report/blocks.h"

namespace patrol::app {

/// [variant] as a page names it: of each key the last part only ("range_noise_m=0.03"), where those differ.
std::vector<std::string> short_names(const SweepManifest& manifest);

/// Every value of one metric by variant, the differences from the first variant, and both in figures.
std::vector<render::Block> comparison_blocks(const SweepManifest& manifest, const SweepRows& rows, const SweepProgress& progress, const std::string& metric);

/// How each run ended, those that did not come to their end first.
render::FoldedTables run_table(const SweepManifest& manifest, const SweepRows& rows, const SweepProgress& progress);

}  // namespace patrol::app
