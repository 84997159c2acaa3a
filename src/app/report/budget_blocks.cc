#include "app/report/budget_blocks.h"

#include <fmt/format.h>

#include "report/quantity.h"

namespace patrol::app {
namespace {

using report::Tone;

/// Steps of a waterfall chart, in the metric's display unit.
class Waterfall {
 public:
  explicit Waterfall(const Budget& budget) : unit_(report::unit_of(budget.metric)), level_(budget.baseline->center) {
    chart_.caption = "From the baseline to all ideal: removing a source lowers the metric by its contribution";
  }

  /// Adds a bar from zero.
  void total(const std::string& label, const score::Interval& value) {
    add(label, 0.0, value.center, value, Tone::kPlain,
        fmt::format("{:.3g} {}", unit_.factor * value.center, unit_.name));
  }
  /// Adds a bar down from the end of the previous step. Its text is the contribution, as in the table.
  void step(const std::string& label, const score::Interval& contribution, Tone tone) {
    const double next = level_ - contribution.center;
    add(label, level_, next, {.center = next, .low = level_ - contribution.high, .high = level_ - contribution.low},
        tone, fmt::format("{:+.3g} {}", unit_.factor * contribution.center, unit_.name));
    level_ = next;
  }
  report::WaterfallChart chart() && { return std::move(chart_); }

 private:
  void add(const std::string& label, double from, double to, const score::Interval& about, Tone tone,
           const std::string& text) {
    chart_.spans.push_back({.label = label,
                            .from = unit_.factor * from,
                            .to = unit_.factor * to,
                            .interval = std::pair(unit_.factor * about.low, unit_.factor * about.high),
                            .tone = tone,
                            .text = text});
    chart_.unit = unit_.name;
  }

  report::Unit unit_;
  double level_;
  report::WaterfallChart chart_;
};

bool is_whole(const Budget& budget) { return budget.baseline && budget.ideal && budget.sum && budget.interaction; }

Tone tone_of(const Contribution& contribution) {
  if (!contribution.is_significant()) return Tone::kFaint;
  return contribution.value->center > 0.0 ? Tone::kBad : Tone::kGood;
}

std::string with_interval(const score::Interval& value, const report::Unit& unit) {
  return fmt::format("{:+.3g} [{:+.3g}, {:+.3g}]", unit.factor * value.center, unit.factor * value.low,
                     unit.factor * value.high);
}

}  // namespace

std::vector<report::Block> budget_blocks(const Budget& budget) {
  if (!is_whole(budget)) return {report::TextBlock{"Too few runs with this metric."}};
  const report::Unit unit = report::unit_of(budget.metric);
  Waterfall waterfall(budget);
  waterfall.total("baseline", *budget.baseline);
  report::TableBlock table{
      .caption = "",
      .columns = {{"error source"}, {"seeds", true}, {fmt::format("contribution, {}", unit.name), true}, {""}},
      .rows = {}};
  for (const Contribution& contribution : budget.contributions) {
    if (!contribution.value) continue;
    waterfall.step(contribution.name, *contribution.value, tone_of(contribution));
    table.rows.push_back({{contribution.name},
                          {std::to_string(contribution.num_pairs)},
                          {with_interval(*contribution.value, unit)},
                          {contribution.is_significant() ? "" : "not significant", Tone::kFaint}});
  }
  waterfall.step("interaction", *budget.interaction, Tone::kPlain);
  waterfall.total("all ideal", *budget.ideal);
  table.rows.push_back({{"sum of the contributions"}, {""}, {with_interval(*budget.sum, unit)}, {""}});
  table.rows.push_back({{"interaction"}, {""}, {with_interval(*budget.interaction, unit)}, {""}});
  return {std::move(waterfall).chart(), table,
          report::TextBlock{fmt::format(
              "Contribution: baseline minus the metric without this error source, paired by seed, with 95 % interval. "
              "Not significant: p-value above 5 % after Holm's correction for {} error sources. Interaction: effect of "
              "removing all minus the sum of the contributions.",
              budget.contributions.size())}};
}

std::string budget_finding(const Budget& budget) {
  if (!is_whole(budget) || budget.contributions.empty() || !budget.contributions.front().value)
    return fmt::format("{}: too few runs with this metric.", budget.metric);
  const report::Unit unit = report::unit_of(budget.metric);
  const std::string whole = fmt::format("{:.3g} {}", unit.factor * budget.baseline->center, unit.name);
  const Contribution* first = first_significant(budget);
  if (first == nullptr) {
    return fmt::format("{}: no error source contributes significantly to {} (5 %, Holm's correction).", budget.metric,
                       whole);
  }
  return fmt::format("{}: {}: {} contributes {:.3g} {}.", budget.metric, whole, first->name,
                     unit.factor * first->value->center, unit.name);
}

}  // namespace patrol::app
