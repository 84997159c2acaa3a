#include "app/campaign/sweep/budget.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace patrol::app {
namespace {

/// Values of a metric, [seed][variant].
using SeedValues = std::vector<std::vector<std::optional<double>>>;

std::vector<double> column(const SeedValues& seed_values, std::size_t variant) {
  std::vector<double> values;
  for (const auto& of_seed : seed_values) {
    if (of_seed[variant]) values.push_back(*of_seed[variant]);
  }
  return values;
}

/// The p-value is not adjusted yet.
Contribution contribution_of(const SeedValues& seed_values, std::size_t variant, const std::string& name) {
  std::vector<double> differences;
  for (const auto& of_seed : seed_values) {
    if (of_seed[0] && of_seed[variant]) differences.push_back(*of_seed[0] - *of_seed[variant]);
  }
  return {.name = name,
          .num_pairs = differences.size(),
          .value = score::mean_interval(differences),
          .p_adjusted = score::mean_p_value(differences)};
}

/// Adds sum and interaction, from the seeds with all values.
void add_sums(const SeedValues& seed_values, Budget& budget) {
  std::vector<double> sums, interactions;
  for (const auto& of_seed : seed_values) {
    if (!std::all_of(of_seed.begin(), of_seed.end(), [](const auto& value) { return value.has_value(); })) continue;
    double sum = 0.0;
    for (std::size_t variant = 1; variant + 1 < of_seed.size(); ++variant) sum += *of_seed[0] - *of_seed[variant];
    sums.push_back(sum);
    interactions.push_back(*of_seed[0] - *of_seed.back() - sum);
  }
  budget.sum = score::mean_interval(sums);
  budget.interaction = score::mean_interval(interactions);
}

std::string numbers(const std::optional<score::Interval>& interval) {
  return interval ? fmt::format("{:+.4g} [{:+.4g}, {:+.4g}]", interval->center, interval->low, interval->high)
                  : "too few runs";
}

/// Text bar from `from` to `to` on a scale of `full`; at its start if `full` is not positive.
std::string bar(double from, double to, double full) {
  constexpr double kWidth = 30.0;
  const auto bar_cell = [&](double value) {
    const double fraction = full > 0.0 ? std::clamp(value / full, 0.0, 1.0) : 0.0;
    return static_cast<std::size_t>(std::lround(kWidth * fraction));
  };
  const std::size_t begin = bar_cell(std::min(from, to)), end = std::max(bar_cell(std::max(from, to)), begin + 1);
  std::string text(begin, ' ');
  for (std::size_t i = begin; i < end; ++i) text += to <= from ? "█" : "▒";
  return text;
}

/// Row of the text of a budget.
struct BudgetLine {
  std::string name, numbers, picture;
};

/// Lines with the columns of their longest names and numbers.
std::string aligned(const std::vector<BudgetLine>& lines) {
  std::size_t name_width = 0, numbers_width = 0;
  for (const BudgetLine& line : lines) {
    name_width = std::max(name_width, line.name.size());
    numbers_width = std::max(numbers_width, line.numbers.size());
  }
  std::string text;
  for (const BudgetLine& line : lines) {
    text += fmt::format("  {:<{}}  {:>{}}", line.name, name_width, line.numbers, numbers_width);
    text += line.picture.empty() ? "\n" : fmt::format("  {}\n", line.picture);
  }
  return text;
}

}  // namespace

const Contribution* first_significant(const Budget& budget) {
  const auto first = std::ranges::find_if(budget.contributions, &Contribution::is_significant);
  return first == budget.contributions.end() ? nullptr : &*first;
}

std::vector<Budget> make_budgets(const SweepManifest& manifest, const SweepRows& rows) {
  std::vector<Budget> budgets;
  for (const std::string& metric : manifest.metrics) budgets.push_back(make_budget(manifest, rows, metric));
  return budgets;
}

Budget make_budget(const SweepManifest& manifest, const SweepRows& rows, const std::string& metric) {
  const SeedValues seed_values = flatten_metrics(manifest, rows, metric);
  Budget budget{.metric = metric,
                .baseline = score::mean_interval(column(seed_values, 0)),
                .ideal = score::mean_interval(column(seed_values, manifest.variants.size() - 1)),
                .contributions = {},
                .sum = {},
                .interaction = {}};
  for (std::size_t variant = 1; variant + 1 < manifest.variants.size(); ++variant) {
    budget.contributions.push_back(contribution_of(seed_values, variant, manifest.variants[variant].name));
  }
  std::vector<std::optional<double>*> p_values;
  for (Contribution& contribution : budget.contributions) p_values.push_back(&contribution.p_adjusted);
  score::adjust_by_holm(p_values);
  const auto center = [](const Contribution& contribution) {
    return contribution.value ? contribution.value->center : 0.0;
  };
  std::stable_sort(budget.contributions.begin(), budget.contributions.end(),
                   [&](const auto& a, const auto& b) { return center(a) > center(b); });
  add_sums(seed_values, budget);
  return budget;
}

std::string budget_text(const Budget& budget) {
  std::string text = fmt::format("{}\n", budget.metric);
  if (!budget.baseline || !budget.ideal || !budget.interaction) return text + "  too few runs with this metric\n";
  double highest = budget.baseline->center, level = highest;
  for (const Contribution& contribution : budget.contributions) {
    level -= contribution.value ? contribution.value->center : 0.0;
    highest = std::max(highest, level);
  }
  level = budget.baseline->center;
  std::vector<BudgetLine> lines = {{"baseline", numbers(budget.baseline), bar(0.0, level, highest)}};
  for (const Contribution& contribution : budget.contributions) {
    const double next = level - (contribution.value ? contribution.value->center : 0.0);
    lines.push_back({contribution.name, numbers(contribution.value),
                     bar(level, next, highest) + (contribution.is_significant() ? "" : "  not significant")});
    level = next;
  }
  lines.push_back({"interaction", numbers(budget.interaction), bar(level, budget.ideal->center, highest)});
  lines.push_back({"all ideal", numbers(budget.ideal), bar(0.0, budget.ideal->center, highest)});
  lines.push_back({"sum of the contributions", numbers(budget.sum), ""});
  return text + aligned(lines) +
         fmt::format("  not significant: p-value above 5 % after Holm's correction for {} error sources\n",
                     budget.contributions.size());
}

io::Table budget_table(const std::vector<Budget>& budgets) {
  io::Table table{
      .name = "budget", .columns = {"metric", "row", "pairs", "value", "low", "high", "p_adjusted"}, .rows = {}};
  for (const Budget& budget : budgets) {
    const auto add = [&](const std::string& row, std::optional<std::size_t> pairs,
                         const std::optional<score::Interval>& interval, std::optional<double> p_adjusted = {}) {
      std::vector<io::TableValue>& cells = table.rows.emplace_back();
      cells.emplace_back(budget.metric);
      cells.emplace_back(row);
      cells.resize(table.columns.size());
      if (pairs) cells[2] = static_cast<std::int64_t>(*pairs);
      if (!interval) return;
      cells[3] = interval->center;
      cells[4] = interval->low;
      cells[5] = interval->high;
      if (p_adjusted) cells[6] = *p_adjusted;
    };
    add("baseline", {}, budget.baseline);
    for (const Contribution& contribution : budget.contributions)
      add(contribution.name, contribution.num_pairs, contribution.value, contribution.p_adjusted);
    add("sum", {}, budget.sum);
    add("interaction", {}, budget.interaction);
    add("all ideal", {}, budget.ideal);
  }
  return table;
}

}  // namespace patrol::app
