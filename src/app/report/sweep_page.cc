#include "app/report/sweep_page.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/campaign/sweep/fault_outcomes.h"
#include "app/report/budget_blocks.h"
#include "app/report/comparison_blocks.h"
#include "core/text.h"

namespace patrol::app {
namespace {

using report::Tone;

std::string not_done(const SweepRows& rows, const SweepProgress& progress) {
  const auto num = std::count_if(progress.counted.begin(), progress.counted.end(),
                                 [&](std::size_t i) { return rows[i]->code() != ExitCode::kDone; });
  return num == 0 ? fmt::format(" All {} runs ended as expected.", progress.counted.size())
                  : fmt::format(" {} of {} runs did not end as expected.", num, progress.counted.size());
}

report::VerdictBlock sweep_verdict(const SweepManifest& manifest, const SweepRows& rows,
                                   const SweepProgress& progress) {
  const std::string& metric = manifest.metrics.front();
  const std::vector<std::string> names = short_names(manifest);
  std::vector<std::string> better, worse, undecided;
  for (std::size_t variant = 1; variant < manifest.variants.size(); ++variant) {
    const VariantMetric entry =
        compare(manifest, rows, metric, progress.num_seeds[variant], confidence_level(manifest))[variant];
    if (entry.verdict == "lower") better.push_back(names[variant]);
    if (entry.verdict == "higher") worse.push_back(names[variant]);
    if (entry.verdict == "runs failed") undecided.push_back(names[variant]);
  }
  report::VerdictBlock verdict;
  if (manifest.variants.size() == 1) {
    verdict.word = "One variant";
    verdict.reason = "No comparison.";
  } else if (better.empty() && worse.empty() && !undecided.empty()) {
    verdict.word = "Runs failed";
    verdict.tone = Tone::kBad;
    verdict.reason = fmt::format("{}: no comparison with {} for {}.", metric, names.front(), join(undecided, "; "));
  } else if (better.empty() && worse.empty()) {
    verdict.word = "No difference";
    verdict.tone = Tone::kFaint;
    verdict.reason = fmt::format("{}: no variant differs significantly from {}.", metric, names.front());
  } else {
    verdict.word = fmt::format("{} of {} differ", better.size() + worse.size(), manifest.variants.size() - 1);
    verdict.reason = fmt::format("{}, relative to {}:", metric, names.front());
    if (!better.empty()) verdict.reason += fmt::format(" lower with {}.", join(better, "; "));
    if (!worse.empty()) verdict.reason += fmt::format(" higher with {}.", join(worse, "; "));
  }
  verdict.reason += not_done(rows, progress);
  return verdict;
}

report::VerdictBlock budget_verdict(const std::vector<Budget>& budgets, const SweepRows& rows,
                                    const SweepProgress& progress) {
  report::VerdictBlock verdict;
  const Contribution* first = budgets.empty() ? nullptr : first_significant(budgets.front());
  verdict.word = first != nullptr ? first->name : "No significant contribution";
  for (const Budget& budget : budgets) verdict.reason += budget_finding(budget) + " ";
  verdict.reason += not_done(rows, progress);
  return verdict;
}

Tone tone_of(FaultOutcome outcome) {
  switch (outcome) {
    case FaultOutcome::kSurvived:
      return Tone::kGood;
    case FaultOutcome::kDegraded:
    case FaultOutcome::kStopped:
      return Tone::kWarning;
    default:
      return Tone::kBad;
  }
}

/// Table of faults.csv, ordered by fault.
report::TableBlock fault_table(const SweepManifest& manifest, const std::vector<FaultRow>& rows) {
  report::TableBlock table{
      .caption = "",
      .columns = {{"fault"}, {"seed", true}, {"triggered"}, {"effect"}, {"outcome"}, {"detected", true}, {"end"}},
      .rows = {}};
  for (const std::string& metric : manifest.metrics) table.columns.push_back({metric, true});
  for (const FaultRow& row : rows) {
    std::vector<report::TableCell> cells = {{row.name},
                                            {std::to_string(row.seed)},
                                            {trigger_text(row), row.is_not_triggered() ? Tone::kWarning : Tone::kPlain},
                                            {effect_text(row), row.is_without_effect() ? Tone::kWarning : Tone::kPlain},
                                            {std::string(text_of(row.outcome)), tone_of(row.outcome)},
                                            {row.num_detected ? fmt::format("{:.0f}", *row.num_detected) : "–"},
                                            {row.end}};
    for (const auto& entry : row.values) cells.push_back({entry ? fmt::format("{:.4g}", *entry) : "–"});
    table.rows.push_back(cells);
  }
  return table;
}

report::VerdictBlock faults_verdict(const std::vector<FaultRow>& rows) {
  const auto count = [&](FaultOutcome outcome) {
    return std::count_if(rows.begin(), rows.end(), [&](const FaultRow& row) { return row.outcome == outcome; });
  };
  const auto num_bad = count(FaultOutcome::kUnsafe) + count(FaultOutcome::kNoResult);
  report::VerdictBlock verdict;
  verdict.word = num_bad == 0 ? "No fault was unsafe" : fmt::format("{} of {} runs unsafe", num_bad, rows.size());
  verdict.tone = num_bad == 0 ? Tone::kGood : Tone::kBad;
  verdict.reason = faults_summary(rows);
  return verdict;
}

const char* kind_of(SweepKind kind) {
  switch (kind) {
    case SweepKind::kBudget:
      return "error budget";
    case SweepKind::kFaults:
      return "fault matrix";
    default:
      return "sweep";
  }
}

void add_comparisons(const SweepManifest& manifest, const SweepRows& rows, const SweepProgress& progress,
                     report::Page& page) {
  for (const std::string& metric : manifest.metrics)
    page.sections.push_back({metric, comparison_blocks(manifest, rows, progress, metric)});
}

}  // namespace

report::Page sweep_page(const SweepManifest& manifest, const SweepRows& rows, const SweepProgress& progress) {
  const std::string scenario = manifest.scenario.substr(0, manifest.scenario.rfind('.'));
  report::Page page{
      .kind = fmt::format("report of {} {}", manifest.kind == SweepKind::kBudget ? "an" : "a", kind_of(manifest.kind)),
      .title = scenario,
      .facts = {{"variants", std::to_string(manifest.variants.size())},
                {"seeds", manifest.seeds.size() == 1
                              ? std::to_string(manifest.seeds.front())
                              : fmt::format("{} … {}", manifest.seeds.front(), manifest.seeds.back())},
                {"runs", std::to_string(progress.counted.size())}},
      .sections = {},
      .footer = fmt::format("Generated by patrol report {} from sweep.json and the results in runs/.", PATROL_VERSION)};
  if (!manifest.overrides.empty()) page.facts.emplace_back("set in every run", join(manifest.overrides, ", "));
  switch (manifest.kind) {
    case SweepKind::kSweep:
      page.sections.push_back({"", {sweep_verdict(manifest, rows, progress)}});
      add_comparisons(manifest, rows, progress, page);
      break;
    case SweepKind::kBudget: {
      const std::vector<Budget> budgets = make_budgets(manifest, rows);
      page.sections.push_back({"", {budget_verdict(budgets, rows, progress)}});
      for (const Budget& budget : budgets) page.sections.push_back({budget.metric, budget_blocks(budget)});
      break;
    }
    case SweepKind::kFaults: {
      const std::vector<FaultRow> faults = fault_rows(manifest, rows);
      page.sections.push_back({"", {faults_verdict(faults)}});
      page.sections.push_back({"Faults", {fault_table(manifest, faults), report::TextBlock{fault_legend()}}});
      break;
    }
  }
  page.sections.push_back({"Runs", {run_table(manifest, rows, progress)}});
  return page;
}

}  // namespace patrol::app
