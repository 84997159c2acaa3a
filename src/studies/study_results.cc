#include "studies/study_results.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "report/boxes.h"

namespace patrol::studies {
namespace {

constexpr double kLevel = 0.05;

io::TableValue number(const std::optional<double>& value) { return value ? io::TableValue{*value} : io::TableValue{}; }

std::optional<double> published(const StudyVariant& variant, std::size_t metric) {
  return metric < variant.published.size() ? variant.published[metric] : std::nullopt;
}

/// Mean with its interval as text, three significant digits.
std::string with_interval(const std::optional<score::Interval>& interval, double mean, const char* sign) {
  const auto text = [&](double value) { return fmt::format(fmt::runtime(fmt::format("{{:{}.3g}}", sign)), value); };
  return interval ? fmt::format("{} [{}, {}]", text(mean), text(interval->low), text(interval->high)) : text(mean);
}

/// Number of failed seeds, marked if it differs from the reference's.
std::string failures_text(const StudyResult& result) {
  const bool differs = result.adjusted_failure_p_value.value_or(1.0) < kLevel;
  return std::to_string(result.num_failed) + (differs ? " *" : "");
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
    if (f == 0) table.columns.push_back({"failed", true});
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
      if (f == 0) row.push_back({result.num_failed > 0 ? failures_text(result) : ""});
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

/// p-value of equal failure rates; none if both fail on the same seeds.
std::optional<double> failure_p_value(const std::vector<StudySample>& samples, std::size_t variant,
                                      std::size_t reference) {
  int num_only_variant = 0, num_only_reference = 0;
  for (const StudySample& sample : samples) {
    const bool has_failed = !std::isfinite(sample[variant].front()),
               reference_has_failed = !std::isfinite(sample[reference].front());
    num_only_variant += has_failed && !reference_has_failed ? 1 : 0;
    num_only_reference += reference_has_failed && !has_failed ? 1 : 0;
  }
  if (num_only_variant + num_only_reference == 0) return std::nullopt;
  return score::sign_test_p_value(num_only_variant, num_only_reference);
}

bool is_comparison(const Study& study, std::size_t variant, std::size_t metric) {
  return study.metrics[metric].is_compared && study.variants[variant].reference != variant;
}

}  // namespace

StudyResults summarize(const Study& study, const std::vector<StudySample>& samples) {
  StudyResults results(study.variants.size(), std::vector<StudyResult>(study.metrics.size()));
  std::vector<std::optional<double>*> p_values;
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
                .adjusted_p_value = {},
                .num_seeds = values.size(),
                .adjusted_failure_p_value = {},
                .num_failed = f == 0 ? samples.size() - values.size() : 0,
                .num_paired = differences.size()};
      if (!is_comparison(study, v, f)) continue;
      result.difference = score::mean_interval(differences);
      result.adjusted_p_value = score::mean_p_value(differences);
      if (result.adjusted_p_value) p_values.push_back(&result.adjusted_p_value);
      if (f > 0) continue;
      result.adjusted_failure_p_value = failure_p_value(samples, v, study.variants[v].reference);
      if (result.adjusted_failure_p_value) p_values.push_back(&result.adjusted_failure_p_value);
    }
  }
  score::adjust_by_holm(p_values);
  return results;
}

ComparisonCount count_comparisons(const Study& study, const StudyResults& results) {
  ComparisonCount count;
  for (std::size_t v = 0; v < study.variants.size(); ++v) {
    for (std::size_t f = 0; f < study.metrics.size(); ++f) {
      if (!is_comparison(study, v, f)) continue;
      const StudyResult& result = results[v][f];
      ++count.num_comparisons;
      const bool is_tested = result.difference.has_value();
      count.num_failure_comparisons += result.adjusted_failure_p_value ? 1 : 0;
      count.num_failure_differences += result.adjusted_failure_p_value.value_or(1.0) < kLevel ? 1 : 0;
      count.num_untested += is_tested ? 0 : 1;
      count.num_uncorrected += is_tested && !result.difference->contains(0.0) ? 1 : 0;
      count.num_significant += is_tested && verdict_of(result) != "no difference" ? 1 : 0;
    }
  }
  return count;
}

std::string comparison_text(const Study& study, const StudyResults& results) {
  const ComparisonCount count = count_comparisons(study, results);
  std::size_t num_failed = 0;
  for (const std::vector<StudyResult>& of_variant : results) num_failed += of_variant.front().num_failed;
  return fmt::format(
      "{} comparisons, {} of them with fewer than two pairs: {} differences at 5 % after Holm's correction ({} without "
      "it). They are over the seeds on which both have a value. Failed runs: {}; {} comparisons of failure rates, in "
      "the "
      "same correction: {} differences.",
      count.num_comparisons, count.num_untested, count.num_significant, count.num_uncorrected, num_failed,
      count.num_failure_comparisons, count.num_failure_differences);
}

std::string verdict_of(const StudyResult& result) {
  if (!result.difference) return "";
  if (result.adjusted_p_value.value_or(1.0) >= kLevel) return "no difference";
  return result.difference->center < 0.0 ? "lower" : "higher";
}

io::Table results_table(const Study& study, const StudyResults& results) {
  io::Table table{.name = "results",
                  .columns = {"world", "method", "particles", "figure", "unit", "published", "seeds", "mean",
                              "mean_low", "mean_high", "difference", "difference_low", "difference_high", "verdict",
                              "failed", "pairs", "adjusted_p_value", "adjusted_failure_p_value"},
                  .rows = {}};
  for (std::size_t v = 0; v < study.variants.size(); ++v) {
    const StudyVariant& variant = study.variants[v];
    for (std::size_t f = 0; f < study.metrics.size(); ++f) {
      const StudyResult& result = results[v][f];
      if (study.metrics[f].is_processor_time || (result.num_seeds == 0 && result.num_failed == 0)) continue;
      const auto part = [](const std::optional<score::Interval>& interval, double score::Interval::*end) {
        return interval ? io::TableValue{(*interval).*end} : io::TableValue{};
      };
      table.rows.push_back(
          {variant.world, variant.method, static_cast<std::int64_t>(variant.particles), study.metrics[f].name,
           study.metrics[f].unit, number(published(variant, f)), static_cast<std::int64_t>(result.num_seeds),
           result.num_seeds > 0 ? io::TableValue{result.mean} : io::TableValue{},
           part(result.interval, &score::Interval::low), part(result.interval, &score::Interval::high),
           part(result.difference, &score::Interval::center), part(result.difference, &score::Interval::low),
           part(result.difference, &score::Interval::high), verdict_of(result),
           f == 0 ? io::TableValue{static_cast<std::int64_t>(result.num_failed)} : io::TableValue{},
           static_cast<std::int64_t>(result.num_paired), number(result.adjusted_p_value),
           number(result.adjusted_failure_p_value)});
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
  return text + comparison_text(study, results) + "\n";
}

report::Page study_page(const Study& study, const std::vector<std::uint64_t>& seeds,
                        const std::vector<StudySample>& samples, const StudyResults& results) {
  report::Page page{.kind = "study",
                    .title = study.title,
                    .facts = {{"source", study.source}, {"seeds", fmt::format("{} … {}", seeds.front(), seeds.back())}},
                    .sections = {},
                    .footer = fmt::format("Generated by patrol study {} {}.", study.name, PATROL_VERSION)};
  page.sections.push_back(
      {"", {report::TextBlock{study.conditions}, report::TextBlock{comparison_text(study, results)}}});
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
