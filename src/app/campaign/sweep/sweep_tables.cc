#include "app/campaign/sweep/sweep_tables.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

namespace patrol::app {
namespace {

io::TableValue number(double value) { return value; }
io::TableValue whole(std::size_t value) { return static_cast<std::int64_t>(value); }

/// Value of a path in the run's overrides; empty if they do not set it.
io::TableValue value_of(const std::vector<std::string>& overrides, const std::string& path) {
  for (const std::string& override : overrides) {
    if (override.starts_with(path + "=")) return override.substr(path.size() + 1);
  }
  return {};
}

bool is_processor_time(const std::string& path) { return path.starts_with("performance."); }

/// Path of every metric, in the order of the first run that has it.
std::vector<std::string> paths_of(const SweepRows& rows, const std::vector<std::size_t>& counted) {
  std::vector<std::string> paths;
  std::set<std::string> seen;
  for (const std::size_t i : counted) {
    for (const auto& [path, value] : io::flatten_metrics(rows[i]->metrics)) {
      if (!is_processor_time(path) && seen.insert(path).second) paths.push_back(path);
    }
  }
  return paths;
}

/// Comparison [metric][variant], each variant over the seeds that were run for it.
std::vector<std::vector<VariantMetric>> comparisons(const SweepManifest& manifest, const SweepRows& rows,
                                                    const SweepProgress& progress) {
  std::vector<std::vector<VariantMetric>> all;
  for (const std::string& metric : manifest.metrics) {
    std::vector<VariantMetric>& values = all.emplace_back();
    for (std::size_t variant = 0; variant < manifest.variants.size(); ++variant) {
      values.push_back(
          compare(manifest, rows, metric, progress.num_seeds[variant], confidence_level(manifest))[variant]);
    }
  }
  return all;
}

std::string spread(const std::optional<score::Interval>& interval) {
  return interval ? fmt::format("{:+.4g} [{:+.4g}, {:+.4g}]", interval->center, interval->low, interval->high) : "";
}

}  // namespace

io::Table runs_table(const SweepManifest& manifest, const SweepRows& rows, const SweepProgress& progress) {
  const std::vector<std::string> paths = paths_of(rows, progress.counted);
  io::Table table{.name = "runs", .columns = {"variant"}, .rows = {}};
  table.columns.insert(table.columns.end(), manifest.paths.begin(), manifest.paths.end());
  for (const char* column : {"seed", "hash", "end", "exit_code", "message"}) table.columns.emplace_back(column);
  table.columns.insert(table.columns.end(), paths.begin(), paths.end());

  for (const std::size_t i : progress.counted) {
    const PlannedRun& run = manifest.runs[i];
    const RunVerdict& result = *rows[i];
    std::vector<io::TableValue>& row = table.rows.emplace_back();
    row.emplace_back(manifest.variants[run.variant].name);
    for (const std::string& path : manifest.paths) row.push_back(value_of(run.overrides, path));
    row.emplace_back(static_cast<std::int64_t>(run.seed));
    row.emplace_back(run.hash);
    row.emplace_back(std::string(name_of(result.end)));
    row.emplace_back(static_cast<std::int64_t>(result.code()));
    row.emplace_back(result.message);
    std::map<std::string, double> values;
    for (const auto& [path, value] : io::flatten_metrics(result.metrics)) values[path] = value;
    for (const std::string& path : paths) {
      const auto entry = values.find(path);
      row.push_back(entry == values.end() ? io::TableValue{} : number(entry->second));
    }
  }
  return table;
}

io::Table comparison_table(const SweepManifest& manifest, const SweepRows& rows, const SweepProgress& progress) {
  io::Table table{.name = "comparison",
                  .columns = {"metric", "variant", "runs", "failed", "mean", "mean_low", "mean_high", "pairs",
                              "difference", "difference_low", "difference_high", "p_adjusted", "verdict"},
                  .rows = {}};
  const auto add_interval = [](std::vector<io::TableValue>& row, const std::optional<score::Interval>& interval) {
    row.push_back(interval ? number(interval->low) : io::TableValue{});
    row.push_back(interval ? number(interval->high) : io::TableValue{});
  };
  const auto all = comparisons(manifest, rows, progress);
  for (std::size_t metric = 0; metric < all.size(); ++metric) {
    for (const VariantMetric& entry : all[metric]) {
      std::vector<io::TableValue>& row = table.rows.emplace_back();
      row.emplace_back(manifest.metrics[metric]);
      row.emplace_back(manifest.variants[entry.variant].name);
      row.push_back(whole(entry.num_runs));
      row.push_back(whole(entry.num_failed));
      row.push_back(entry.num_runs > 0 ? number(entry.mean) : io::TableValue{});
      add_interval(row, entry.interval);
      row.push_back(whole(entry.num_pairs));
      row.push_back(entry.difference ? number(entry.difference->center) : io::TableValue{});
      add_interval(row, entry.difference);
      row.push_back(entry.p_adjusted ? number(*entry.p_adjusted) : io::TableValue{});
      row.emplace_back(entry.verdict);
    }
  }
  return table;
}

std::string comparison_text(const SweepManifest& manifest, const SweepRows& rows, const SweepProgress& progress) {
  std::size_t width = 8;
  for (const Variant& variant : manifest.variants) width = std::max(width, variant.name.size());
  std::string text;
  const auto all = comparisons(manifest, rows, progress);
  for (std::size_t metric = 0; metric < all.size(); ++metric) {
    const bool has_failures = std::ranges::any_of(all[metric], [](const auto& entry) { return entry.num_failed > 0; });
    const auto failures = [&](const std::string& cell) { return has_failures ? fmt::format("  {:>8}", cell) : ""; };
    text += fmt::format("{}\n  {:<{}}  {:>5}{}  {:>32}  {:>5}  {:>34}\n", manifest.metrics[metric], "variant", width,
                        "runs", failures("failed"), "mean [95 %]", "pairs", "difference from the first");
    for (const VariantMetric& entry : all[metric]) {
      const std::string mean =
          entry.interval ? fmt::format("{:.4g} [{:.4g}, {:.4g}]", entry.mean, entry.interval->low, entry.interval->high)
          : entry.num_runs > 0 ? fmt::format("{:.4g}", entry.mean)
                               : "-";
      text += fmt::format("  {:<{}}  {:>5}{}  {:>32}", manifest.variants[entry.variant].name, width, entry.num_runs,
                          failures(entry.failed_text()), mean);
      if (entry.variant > 0)
        text += fmt::format("  {:>5}  {:>34}  {}", entry.num_pairs, spread(entry.difference), entry.verdict);
      text += "\n";
    }
    text += "\n";
  }
  if (manifest.variants.size() > 2)
    text += fmt::format("verdicts: 5 % after Holm's correction for {} variants\n", manifest.variants.size() - 1);
  if (manifest.stop.is_early) {
    text += fmt::format("differences: intervals for {} interim analyses (Bonferroni)\n",
                        interim_analyses(manifest.seeds.size()).size());
  }
  return text;
}

}  // namespace patrol::app
