#include "app/campaign/sweep/sweep_rows.h"

namespace patrol::app {

SweepRows load_rows(const SweepManifest& manifest, const ResultStore& store) {
  SweepRows rows;
  for (const PlannedRun& run : manifest.runs) rows.push_back(store.load(run.hash));
  return rows;
}

std::vector<std::vector<std::optional<double>>> flatten_metrics(const SweepManifest& manifest, const SweepRows& rows,
                                                                const std::string& metric) {
  std::vector<std::vector<std::optional<double>>> values(manifest.seeds.size(),
                                                         std::vector<std::optional<double>>(manifest.variants.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] && !is_failure(rows[i]->end))
      values[i / manifest.variants.size()][manifest.runs[i].variant] = io::metric_at(rows[i]->metrics, metric);
  }
  return values;
}

std::size_t count_failures(const SweepManifest& manifest, const SweepRows& rows, std::size_t variant,
                           std::size_t num_seeds) {
  std::size_t num_failed = 0;
  for (std::size_t i = 0; i < rows.size() && i / manifest.variants.size() < num_seeds; ++i) {
    if (manifest.runs[i].variant == variant && rows[i] && is_failure(rows[i]->end)) ++num_failed;
  }
  return num_failed;
}

}  // namespace patrol::app
