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
    if (rows[i])
      values[i / manifest.variants.size()][manifest.runs[i].variant] = io::metric_at(rows[i]->metrics, metric);
  }
  return values;
}

}  // namespace patrol::app
