#include "app/report/comparison_blocks.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/text.h"
#include "report/boxes.h"

namespace patrol::app {
namespace {

using report::Tone;

/// Tone of a difference by its verdict, which is corrected for the number of variants.
Tone tone_of(const VariantMetric& entry) {
  return entry.verdict == "lower" || entry.verdict == "higher" ? Tone::kPlain : Tone::kFaint;
}

std::string interval_text(const std::optional<score::Interval>& interval, const report::Unit& unit, const char* sign) {
  if (!interval) return "–";
  const auto number = [&](double value) {
    return fmt::format(fmt::runtime(fmt::format("{{:{}.4g}}", sign)), unit.factor * value);
  };
  return fmt::format("{} [{}, {}]", number(interval->center), number(interval->low), number(interval->high));
}

}  // namespace

std::vector<std::string> short_names(const SweepManifest& manifest) {
  std::map<std::string, std::string> short_paths;  // [path]
  std::set<std::string> taken;
  for (const std::string& path : manifest.paths) taken.insert(short_paths[path] = path.substr(path.rfind('.') + 1));
  const bool are_unique = taken.size() == manifest.paths.size();
  std::vector<std::string> names;
  for (const Variant& variant : manifest.variants) {
    std::vector<std::string> parts;
    for (const std::string& override : variant.overrides) {
      const std::size_t equals = override.find('=');
      const auto known = short_paths.find(override.substr(0, equals));
      if (known != short_paths.end()) parts.push_back(known->second + override.substr(equals));
    }
    const bool is_shown = manifest.kind == SweepKind::kSweep && are_unique && !parts.empty();
    names.push_back(is_shown ? join(parts, ", ") : variant.name);
  }
  return names;
}

std::vector<report::Block> comparison_blocks(const SweepManifest& manifest, const SweepRows& rows,
                                             const SweepProgress& progress, const std::string& metric) {
  const report::Unit unit = report::unit_of(metric);
  const auto seed_values = flatten_metrics(manifest, rows, metric);
  const std::vector<std::string> names = short_names(manifest);
  report::BoxPlot boxes{.caption = "Every run, median and quartiles", .unit = unit.name, .boxes = {}};
  report::WaterfallChart differences{.caption = fmt::format("Difference from {}, paired by seed, {:g} % intervals",
                                                            names.front(), 100.0 * confidence_level(manifest)),
                                     .unit = unit.name,
                                     .spans = {}};
  report::TableBlock table{.caption = "",
                           .columns = {{"variant"},
                                       {"runs", true},
                                       {"failed", true},
                                       {"mean, " + unit.name, true},
                                       {"difference, " + unit.name, true},
                                       {""}},
                           .rows = {}};
  for (std::size_t variant = 0; variant < manifest.variants.size(); ++variant) {
    const std::string& name = names[variant];
    const VariantMetric entry =
        compare(manifest, rows, metric, progress.num_seeds[variant], confidence_level(manifest))[variant];
    std::vector<double> values;
    for (std::size_t seed = 0; seed < progress.num_seeds[variant]; ++seed) {
      if (seed_values[seed][variant]) values.push_back(*seed_values[seed][variant]);
    }
    if (!values.empty()) boxes.boxes.push_back(report::box_of(name, values, unit));
    if (entry.difference) {
      differences.spans.push_back(
          {.label = name,
           .from = 0.0,
           .to = unit.factor * entry.difference->center,
           .interval = std::pair(unit.factor * entry.difference->low, unit.factor * entry.difference->high),
           .tone = tone_of(entry),
           .text = entry.verdict});
    }
    table.rows.push_back({{name},
                          {std::to_string(entry.num_runs)},
                          {entry.failed_text(), entry.num_failed > 0 ? Tone::kBad : Tone::kPlain},
                          {interval_text(entry.interval, unit, "")},
                          {variant == 0 ? "" : interval_text(entry.difference, unit, "+")},
                          {entry.verdict, tone_of(entry)}});
  }
  std::vector<report::Block> blocks;
  if (!boxes.boxes.empty()) blocks.emplace_back(boxes);
  if (!differences.spans.empty()) blocks.emplace_back(differences);
  blocks.emplace_back(table);
  return blocks;
}

report::CollapsibleTables run_table(const SweepManifest& manifest, const SweepRows& rows,
                                    const SweepProgress& progress) {
  const std::vector<std::string> names = short_names(manifest);
  report::TableBlock table{
      .caption = "", .columns = {{"variant"}, {"seed", true}, {"end"}, {"exit code", true}, {"reason"}}, .rows = {}};
  std::vector<std::size_t> order = progress.counted;
  std::stable_partition(order.begin(), order.end(), [&](std::size_t i) { return rows[i]->code() != ExitCode::kDone; });
  for (const std::size_t i : order) {
    const RunVerdict& verdict = *rows[i];
    table.rows.push_back(
        {{names[manifest.runs[i].variant]},
         {std::to_string(manifest.runs[i].seed)},
         {std::string(name_of(verdict.end)), verdict.code() == ExitCode::kDone ? Tone::kGood : Tone::kBad},
         {std::to_string(static_cast<int>(verdict.code()))},
         {verdict.message}});
  }
  return {.summary = fmt::format("All {} runs", order.size()), .tables = {table}};
}

}  // namespace patrol::app
