#pragma once

#include "app/scoring/expectations.h"
#include "io/json/metrics_json.h"
#include "report/blocks.h"

/// Blocks of a page from metrics.json alone.
namespace patrol::app {

/// Main metrics; those that the run did not measure are omitted.
report::KeyMetrics key_metrics(const io::Metrics& metrics);

/// Every metric, one table per group.
report::CollapsibleTables all_metrics(const io::Metrics& metrics, const std::vector<CheckedExpectation>& checks);

/// Blocks of stations, goals, inspection and performance; each is empty without metrics.
std::vector<report::Block> station_blocks(const io::Metrics& metrics);
std::vector<report::Block> goal_blocks(const io::Metrics& metrics);
std::vector<report::Block> inspection_blocks(const io::Metrics& metrics);
std::vector<report::Block> performance_blocks(const io::Metrics& metrics);

}  // namespace patrol::app
