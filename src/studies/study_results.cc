#include "studies/study_results.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "report/boxes.h"

namespace patrol::studies {
namespace {

io::TableValue number(const std::optional<double>& value) { return value ? io::TableValue{*value} : io::TableValue{}; }

std::optional<double> published(const StudyVariant& variant, std::size_t metric) {
  return metric < variant.published.size() ? variant.published[metric] : std::nullopt;
}

/// Mean with its interval as text, three significant digits.
std::string with_interval(const std::optional<score::Interval>& interval, double mean, const char* sign) {
  const auto text = [&](double value) { return fmt::format(fmt::runtime(fmt::format("{{:{}.3g}}", sign)), value); };
  return interval ? fmt::format("{} [{}, {}]", text(mean), text(interval->low), text(interval->high)) : text(mean);
}

std::string title_of(const StudyMetric& metric) {
  return metric.unit.empty() ? metric.name : fmt::format("{}, {}", metric.name, metric.unit);
}

/// Tables of one world: one per compared metric; the first one also has all metrics without comparison.
std::vector<report::TableBlock> tables_of(const Study& study, const StudyResults& results, const std::string& world) {
  // Columns without any value are omitted.
  const bool has_particles = std::any_of(study.variants.begin(), study.variants.end(),
                                         [](const StudyVariant& variant) { return variant.particles > 0; });
  const bool has_published = std::any_of(study.variants.begin(), study.variants.end(),
                                         [](const StudyVariant& variant) { return !variant.published.empty(); });
  std::vector<report::TableBlock> tables;
  for (std::size_t f = 0; f < study.metrics.size(); ++f) {
    if (!study.metrics[f].is_compared) continue;
    report::TableBlock& table = tables.emplace_back(
        report::TableBlock{.caption = title_of(study.metrics[f]), .columns = {{"method"}}, .rows = {}});
    if (has_particles) table.columns.push_back({"N", true});
    if (has_published) table.columns.push_back({"published", true});
    table.columns.push_back({has_published ? "this work" : "mean", true});
    table.columns.push_back({"relative to " + study.compared_with, true});
    const bool is_first = tables.size() == 1;
    for (const StudyMetric& metric : study.metrics) {
      if (is_first && !metric.is_compared) table.columns.push_back({title_of(metric), true});
    }
    for (std::size_t v = 0; v < study.variants.size(); ++v) {
      const StudyVariant& variant = study.variants[v];
      if (variant.world != world) continue;
      const StudyResult& result = results[v][f];
      const auto published_value = published(variant, f);
      std::vector<report::TableCell>& row = table.rows.emplace_back();
      row.push_back({variant.method});
      if (has_particles) row.push_back({variant.particles > 0 ? std::to_string(variant.particles) : ""});
      if (has_published)
        row.push_back({published_value ? fmt::format("{:.4g}", *published_value) : "–", report::Tone::kFaint});
      row.push_back({result.num_seeds > 0 ? with_interval(result.interval, result.mean, "") : "–"});
      row.push_back({result.difference ? with_interval(result.difference, result.difference->center, "+") : "",
                     verdict_of(result) == "no difference" ? report::Tone::kFaint : report::Tone::kPlain});
      for (std::size_t other = 0; is_first && other < study.metrics.size(); ++other) {
        if (study.metrics[other].is_compared) continue;
        row.push_back({results[v][other].num_seeds > 0 ? fmt::format("{:.3g}", results[v][other].mean) : "–"});
      }
    }
  }
  return tables;
}

std::vector<std::string> worlds_of(const Study& study) {
  std::vector<std::string> worlds;
  for (const StudyVariant& variant : study.variants) {
    if (std::find(worlds.begin(), worlds.end(), variant.world) == worlds.end()) worlds.push_back(variant.world);
  }
  return worlds;
}

std::string label_of(const StudyVariant& variant) {
  return variant.particles > 0 ? fmt::format("{} ({})", variant.method, variant.particles) : variant.method;
}

/// Display width of a text; the few non-ASCII characters in use take one column each.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

/// Formats a table in aligned columns, numbers right-aligned.
std::string aligned(const report::TableBlock& table) {
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    widths.push_back(width_of(table.columns[c].title));
    for (const auto& row : table.rows) widths[c] = std::max(widths[c], width_of(row[c].text));
  }
  std::string text;
  const auto add = [&](std::size_t c, const std::string& word) {
    const std::string space(widths[c] - width_of(word), ' ');
    text += (c > 0 ? "  " : "") + (table.columns[c].is_number ? space + word : word + space);
  };
  for (std::size_t c = 0; c < table.columns.size(); ++c) add(c, table.columns[c].title);
  for (const auto& row : table.rows) {
    text += "\n";
    for (std::size_t c = 0; c < row.size(); ++c) add(c, row[c].text);
  }
  return text + "\n";
}

}  // namespace

StudyResults summarize(const Study& study, const std::vector<StudySample>& samples) {
  StudyResults results(study.variants.size(), std::vector<StudyResult>(study.metrics.size()));
  for (std::size_t v = 0; v < study.variants.size(); ++v) {
    for (std::size_t f = 0; f < study.metrics.size(); ++f) {
      std::vector<double> values, differences;
      for (const StudySample& sample : samples) {
        const double value = sample[v][f], reference = sample[study.variants[v].reference][f];
        if (std::isfinite(value)) values.push_back(value);
        if (std::isfinite(value) && std::isfinite(reference)) differences.push_back(value - reference);
      }
      StudyResult& result = results[v][f];
      result = {.mean = score::mean(values),
                .interval = score::mean_interval(values),
                .difference = {},
                .num_seeds = values.size()};
      if (study.metrics[f].is_compared && study.variants[v].reference != v)
        result.difference = score::mean_interval(differences);
    }
  }
  return results;
}

std::string verdict_of(const StudyResult& result) {
  if (!result.difference) return "";
  if (result.difference->contains(0.0)) return "no difference";
  return result.difference->center < 0.0 ? "lower" : "higher";
}

io::Table results_table(const Study& study, const StudyResults& results) {
  io::Table table{.name = "results",
                  .columns = {"world", "method", "particles", "figure", "unit", "published", "seeds", "mean",
                              "mean_low", "mean_high", "difference", "difference_low", "difference_high", "verdict"},
                  .rows = {}};
  for (std::size_t v = 0; v < study.variants.size(); ++v) {
    const StudyVariant& variant = study.variants[v];
    for (std::size_t f = 0; f < study.metrics.size(); ++f) {
      const StudyResult& result = results[v][f];
      if (study.metrics[f].is_processor_time || result.num_seeds == 0) continue;
      const auto part = [](const std::optional<score::Interval>& interval, double score::Interval::*end) {
        return interval ? io::TableValue{(*interval).*end} : io::TableValue{};
      };
      table.rows.push_back(
          {variant.world, variant.method, static_cast<std::int64_t>(variant.particles), study.metrics[f].name,
           study.metrics[f].unit, number(published(variant, f)), static_cast<std::int64_t>(result.num_seeds),
           result.mean, part(result.interval, &score::Interval::low), part(result.interval, &score::Interval::high),
           part(result.difference, &score::Interval::center), part(result.difference, &score::Interval::low),
           part(result.difference, &score::Interval::high), verdict_of(result)});
    }
  }
  return table;
}

io::Table performance_table(const Study& study, const StudyResults& results) {
  io::Table table{
      .name = "performance", .columns = {"world", "method", "particles", "figure", "unit", "mean"}, .rows = {}};
  for (std::size_t v = 0; v < study.variants.size(); ++v) {
    for (std::size_t f = 0; f < study.metrics.size(); ++f) {
      if (!study.metrics[f].is_processor_time || results[v][f].num_seeds == 0) continue;
      table.rows.push_back({study.variants[v].world, study.variants[v].method,
                            static_cast<std::int64_t>(study.variants[v].particles), study.metrics[f].name,
                            study.metrics[f].unit, results[v][f].mean});
    }
  }
  return table;
}

io::Table samples_table(const Study& study, const std::vector<std::uint64_t>& seeds,
                        const std::vector<StudySample>& samples) {
  io::Table table{.name = "runs", .columns = {"seed", "world", "method", "particles"}, .rows = {}};
  for (const StudyMetric& metric : study.metrics) {
    if (!metric.is_processor_time) table.columns.push_back(title_of(metric));
  }
  for (std::size_t s = 0; s < samples.size(); ++s) {
    for (std::size_t v = 0; v < study.variants.size(); ++v) {
      std::vector<io::TableValue>& row = table.rows.emplace_back();
      row.emplace_back(static_cast<std::int64_t>(seeds[s]));
      row.emplace_back(study.variants[v].world);
      row.emplace_back(study.variants[v].method);
      row.emplace_back(static_cast<std::int64_t>(study.variants[v].particles));
      for (std::size_t f = 0; f < study.metrics.size(); ++f) {
        if (study.metrics[f].is_processor_time) continue;
        row.push_back(std::isfinite(samples[s][v][f]) ? io::TableValue{samples[s][v][f]} : io::TableValue{});
      }
    }
  }
  return table;
}

std::string results_text(const Study& study, const StudyResults& results) {
  std::string text;
  for (const std::string& world : worlds_of(study)) {
    for (const report::TableBlock& table : tables_of(study, results, world))
      text += fmt::format("{}: {}\n{}\n", world, table.caption, aligned(table));
  }
  return text;
}

report::Page study_page(const Study& study, const std::vector<std::uint64_t>& seeds,
                        const std::vector<StudySample>& samples, const StudyResults& results) {
  report::Page page{.kind = "study",
                    .title = study.title,
                    .facts = {{"source", study.source}, {"seeds", fmt::format("{} … {}", seeds.front(), seeds.back())}},
                    .sections = {},
                    .footer = fmt::format("Generated by patrol study {} {}.", study.name, PATROL_VERSION)};
  page.sections.push_back({"", {report::TextBlock{study.conditions}}});
  for (const std::string& world : worlds_of(study)) {
    report::Section section{world, {}};
    for (report::TableBlock& table : tables_of(study, results, world)) section.blocks.emplace_back(std::move(table));
    const StudyMetric& first = study.metrics.front();
    report::BoxPlot boxes{
        .caption = fmt::format("{}: every seed, median and quartiles", first.name), .unit = first.unit, .boxes = {}};
    for (std::size_t v = 0; v < study.variants.size(); ++v) {
      if (study.variants[v].world != world) continue;
      std::vector<double> values;
      for (const StudySample& sample : samples) {
        if (std::isfinite(sample[v].front())) values.push_back(sample[v].front());
      }
      if (!values.empty())
        boxes.boxes.push_back(report::box_of(label_of(study.variants[v]), values, {.factor = 1.0, .name = first.unit}));
    }
    section.blocks.emplace_back(std::move(boxes));
    page.sections.push_back(std::move(section));
  }
  for (report::Section& section : study.illustrate(seeds.front())) page.sections.push_back(std::move(section));
  return page;
}

}  // namespace patrol::studies
