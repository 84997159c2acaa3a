#include "app/campaign/sweep/fault_outcomes.h"

#include <algorithm>
#include <array>
#include <map>

#include <fmt/format.h>

#include "core/text.h"

namespace patrol::app {
namespace {

/// Whether the single declared fault of a run was triggered; none without a fault.
std::optional<bool> was_triggered(const RunVerdict& verdict) {
  const auto fault = std::find_if(verdict.events.begin(), verdict.events.end(),
                                  [](const InjectedEvent& event) { return event.is_fault(); });
  return fault == verdict.events.end() ? std::nullopt : std::optional(fault->was_triggered);
}

/// Metrics by which a run with a fault is compared with the one without.
io::Metrics compared_metrics(const RunVerdict& verdict) {
  io::Metrics metrics = verdict.metrics;
  if (!metrics.is_object()) return metrics;
  metrics.erase("performance");
  if (metrics.contains("mission")) metrics["mission"].erase("sensor_faults_noticed");
  return metrics;
}

}  // namespace

FaultOutcome outcome_of(const RunVerdict& verdict) {
  const auto completed = io::metric_at(verdict.metrics, "mission.completed");
  if (!completed) return FaultOutcome::kNoResult;
  if (verdict.end == RunStatus::kFall || io::metric_at(verdict.metrics, "mission.collisions").value_or(0.0) > 0.0)
    return FaultOutcome::kUnsafe;
  if (*completed == 0.0) return FaultOutcome::kStopped;
  return verdict.code() == ExitCode::kDone ? FaultOutcome::kSurvived : FaultOutcome::kDegraded;
}

std::string_view text_of(FaultOutcome outcome) { return row_of(kFaultOutcomes, outcome).name; }

std::vector<FaultRow> fault_rows(const SweepManifest& manifest, const SweepRows& rows) {
  std::vector<FaultRow> faults;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const PlannedRun& run = manifest.runs[i];
    const RunVerdict& verdict = *rows[i];
    const RunVerdict& baseline = *rows[i - run.variant];
    FaultRow& row =
        faults.emplace_back(FaultRow{.name = manifest.variants[run.variant].name,
                                     .fault = parse_variant_name(manifest.variants[run.variant].name),
                                     .seed = run.seed,
                                     .was_triggered = was_triggered(verdict),
                                     .has_effect = compared_metrics(verdict) != compared_metrics(baseline),
                                     .outcome = outcome_of(verdict),
                                     .num_detected = io::metric_at(verdict.metrics, "mission.sensor_faults_noticed"),
                                     .end = std::string(name_of(verdict.end)),
                                     .message = verdict.message,
                                     .values = {},
                                     .baseline_values = {}});
    for (const std::string& metric : manifest.metrics) {
      row.values.push_back(io::metric_at(verdict.metrics, metric));
      row.baseline_values.push_back(io::metric_at(baseline.metrics, metric));
    }
  }
  return faults;
}

std::string trigger_text(const FaultRow& row) {
  if (!row.was_triggered) return "";
  return *row.was_triggered ? "triggered" : "not triggered";
}

std::string effect_text(const FaultRow& row) {
  if (row.fault.kind.empty() || !row.was_triggered.value_or(false)) return "";
  return row.has_effect ? "effect" : "no effect";
}

std::string faults_summary(const std::vector<FaultRow>& rows) {
  std::map<FaultOutcome, int> counts;
  for (const FaultRow& row : rows) ++counts[row.outcome];
  std::vector<std::string> parts;
  for (const auto& [outcome, count] : counts) parts.push_back(fmt::format("{} {}", count, text_of(outcome)));
  return fmt::format("{} runs: {}; {} faults not triggered, {} without effect.", rows.size(), join(parts, ", "),
                     std::ranges::count_if(rows, &FaultRow::is_not_triggered),
                     std::ranges::count_if(rows, &FaultRow::is_without_effect));
}

std::string fault_legend() {
  return "Survived: mission completed without fall or collision, every expectation met. Among the expectations are "
         "bounds of the position error at every instant, of the map's coverage and, on a given map, of the time "
         "reported lost. Degraded: completed, an expectation missed. Stopped: not completed, no fall, no collision. "
         "UNSAFE: a fall or a collision. NO RESULT: the run crashed, timed out or was not scored. No effect: every "
         "metric equals that of the run without fault, so the scenario does not need the sensor. Detected: number of "
         "reported timeouts, frozen readings and clock errors; drift and outliers are not detectable.";
}

}  // namespace patrol::app
