#pragma once

#include "app/scoring/expectations.h"
#include "io/metrics_json.h"
#include "render/report/blocks.h"

/// Blocks of a page from metrics.json alone.
namespace patrol::app {

/// Main metrics; those that the run did not measure are omitted.
render::KeyMetrics key_figures(const io::Metrics& metrics);

/// Every metric, one table per group.
render::CollapsibleTables all_metrics(const io::Metrics& metrics, const std::vector<CheckedExpectation>& checks);

/// Blocks of stations, goals, inspection and performance; each is empty without metrics.
std::vector<render::Block> station_blocks(const io::Metrics& metrics);
std::vector<render::Block> goal_blocks(const io::Metrics& metrics);
std::vector<render::Block> inspection_blocks(const io::Metrics& metrics);
std::vector<render::Block> performance_blocks(const io::Metrics& metrics);

}  // namespace patrol::app
