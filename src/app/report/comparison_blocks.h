#pragma once

#include "app/sweep/comparison.h"
#include "render/report/blocks.h"

namespace patrol::app {

/// Every value of one metric by variant, the differences from the first variant, and both in figures.
std::vector<render::Block> comparison_blocks(const SweepManifest& manifest, const SweepRows& rows, const SweepProgress& progress, const std::string& metric);

/// How each run ended, those that did not come to their end first.
render::FoldedTables run_table(const SweepManifest& manifest, const SweepRows& rows, const SweepProgress& progress);

}  // namespace patrol::app
