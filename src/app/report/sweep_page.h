#pragma once

#include "app/campaign/sweep/comparison.h"
#include "report/blocks.h"

namespace patrol::app {

/// Report page of a complete sweep, error budget or fault matrix.
report::Page sweep_page(const SweepManifest& manifest, const SweepRows& rows, const SweepProgress& progress);

}  // namespace patrol::app
