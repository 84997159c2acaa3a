#pragma once

#include "app/sweep/comparison.h"
#include "render/report/blocks.h"

namespace patrol::app {

/// The page of a sweep, an error budget or a fault matrix whose runs are all there.
render::Page sweep_page(const SweepManifest& manifest, const SweepRows& rows, const SweepProgress& progress);

}  // namespace patrol::app
