#include "app/campaign/test/calibration.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "app/campaign/test/limit_rules.h"
#include "io/json/metrics_json.h"

namespace patrol::app {
namespace {

bool is_one_number(const io::Expectation& expectation) {
  return !expectation.is_boolean && expectation.min == expectation.max;
}

std::vector<std::string> metrics_to_calibrate(const io::Expectations& present,
                                              const std::vector<const SeedRun*>& samples) {
  std::set<std::string> metrics;
  for (const auto& [metric, expectation] : present) metrics.insert(metric);
  for (const SeedRun* run : samples) {
    for (const auto& [metric, value] : io::flatten_metrics(run->verdict.metrics)) {
      if (is_standard(metric)) metrics.insert(metric);
    }
  }
  std::vector<std::string> ordered(metrics.begin(), metrics.end());
  std::stable_sort(ordered.begin(), ordered.end(),
                   [](const std::string& a, const std::string& b) { return rule_index(a) < rule_index(b); });
  return ordered;
}

void propose(CalibratedMetric& calibrated, std::size_t num_samples) {
  if (calibrated.values.size() < num_samples || num_samples == 0) {
    calibrated.note = fmt::format("measured with {} of {} seeds", calibrated.values.size(), num_samples);
    return;
  }
  if (calibrated.present && is_one_number(*calibrated.present)) {
    if (calibrated.is_missed()) calibrated.note = "not equal for all seeds";
    else calibrated.proposed = calibrated.present;
    return;
  }
  const bool is_truth = calibrated.present && calibrated.present->is_boolean;
  calibrated.proposed = limits_of(is_truth ? LimitRule::kTruth : rule_of(calibrated.metric), calibrated.values);
  if (!calibrated.proposed) calibrated.note = "no limit follows from the values";
}

/// Whether no value meets both: every run missed the present expectation by far.
bool are_disjoint(const io::Expectation& a, const io::Expectation& b) {
  const io::Expectation both = narrower(a, b);
  return both.min > both.max;
}

std::string range_text(const CalibratedMetric& metric) {
  if (metric.values.empty()) return "";
  const auto [lowest, highest] = std::minmax_element(metric.values.begin(), metric.values.end());
  if (*lowest == *highest) return fmt::format("{:.3g}", *lowest);
  return fmt::format("{:.3g} to {:.3g}", *lowest, *highest);
}

std::string change_of(const CalibratedMetric& metric) {
  if (!metric.note.empty()) return metric.note;
  if (metric.is_missed()) return "MISSED";
  if (!metric.present) return "new";
  return metric.proposed && is_wider(*metric.proposed, *metric.present) ? "wider than at present" : "";
}

std::string limits_text(const std::optional<io::Expectation>& expectation) {
  return expectation ? to_yaml(*expectation) : "";
}

}  // namespace

bool CalibratedMetric::is_missed() const {
  return present && std::any_of(values.begin(), values.end(),
                                [&](double value) { return value < present->min || value > present->max; });
}

std::optional<double> CalibratedMetric::slack() const {
  if (!present || present->is_boolean || !std::isfinite(present->max) || values.empty()) return std::nullopt;
  const double highest = *std::max_element(values.begin(), values.end());
  return highest > 0.0 ? std::optional(present->max / highest) : std::nullopt;
}

bool is_sample(const io::Expectations& present, const RunVerdict& verdict) {
  if (verdict.end != RunStatus::kDone && verdict.end != RunStatus::kExpectationMissed) return false;
  const auto completed = present.find("mission.completed");
  const double wanted = completed == present.end() ? 1.0 : completed->second.min;
  return io::metric_at(verdict.metrics, "mission.completed") == wanted;
}

Calibration calibrate(const std::string& name, const io::Expectations& present, const std::vector<SeedRun>& runs) {
  Calibration calibration{.name = name, .seeds = {}, .failures = {}, .metrics = {}};
  std::vector<const SeedRun*> samples;
  for (const SeedRun& run : runs) {
    calibration.seeds.push_back(run.seed);
    if (is_sample(present, run.verdict)) {
      samples.push_back(&run);
    } else {
      const bool has_ended = run.verdict.end == RunStatus::kDone || run.verdict.end == RunStatus::kExpectationMissed;
      calibration.failures.push_back(
          fmt::format("seed {}: {}", run.seed, has_ended ? "mission not completed" : name_of(run.verdict.end)));
    }
  }
  for (const std::string& metric : metrics_to_calibrate(present, samples)) {
    CalibratedMetric calibrated{.metric = metric, .present = {}, .values = {}, .proposed = {}, .note = ""};
    if (const auto found = present.find(metric); found != present.end()) calibrated.present = found->second;
    for (const SeedRun* run : samples) {
      if (const auto value = io::metric_at(run->verdict.metrics, metric)) calibrated.values.push_back(*value);
    }
    propose(calibrated, samples.size());
    if (calibrated.present || calibrated.proposed) calibration.metrics.push_back(calibrated);
  }
  return calibration;
}

io::Expectations expectations_of(const Calibration& calibration, bool may_widen) {
  io::Expectations expectations;
  for (const CalibratedMetric& metric : calibration.metrics) {
    if (metric.proposed && (may_widen || !metric.present)) {
      expectations[metric.metric] = *metric.proposed;
    } else if (metric.proposed && !are_disjoint(*metric.proposed, *metric.present)) {
      expectations[metric.metric] = narrower(*metric.proposed, *metric.present);
    } else {
      expectations[metric.metric] = *metric.present;
    }
  }
  return expectations;
}

std::string measured_range(const CalibratedMetric& metric) {
  if (metric.values.empty() || (metric.present && metric.present->is_boolean) ||
      rule_of(metric.metric) == LimitRule::kTruth)
    return "";
  return "measured " + range_text(metric);
}

std::string expect_section(const Calibration& calibration, bool may_widen) {
  const io::Expectations expectations = expectations_of(calibration, may_widen);
  std::string text = "expect:\n";
  for (const CalibratedMetric& metric : calibration.metrics) {
    text += fmt::format("  {}: {}", metric.metric, to_yaml(expectations.at(metric.metric)));
    if (const std::string measured = measured_range(metric); !measured.empty()) text += "  # " + measured;
    text += "\n";
  }
  return text;
}

io::Table calibration_table(const std::vector<Calibration>& calibrations) {
  io::Table table{
      .name = "calibration",
      .columns = {"scenario", "metric", "present", "seeds", "lowest", "highest", "proposed", "slack", "note"},
      .rows = {}};
  for (const Calibration& calibration : calibrations) {
    for (const CalibratedMetric& metric : calibration.metrics) {
      std::vector<io::TableValue>& row = table.rows.emplace_back();
      row = {calibration.name, metric.metric, limits_text(metric.present),
             static_cast<std::int64_t>(metric.values.size())};
      row.resize(table.columns.size());
      if (!metric.values.empty()) {
        const auto [lowest, highest] = std::minmax_element(metric.values.begin(), metric.values.end());
        row[4] = *lowest;
        row[5] = *highest;
      }
      row[6] = limits_text(metric.proposed);
      if (const std::optional<double> slack = metric.slack()) row[7] = *slack;
      row[8] = change_of(metric);
    }
  }
  return table;
}

std::string calibration_text(const Calibration& calibration) {
  std::string text = fmt::format("{}, {} seeds\n", calibration.name, calibration.seeds.size());
  for (const std::string& failure : calibration.failures) text += "  " + failure + "\n";
  text += fmt::format("  {:<40} {:>26} {:>18} {:>26} {:>7}\n", "metric", "present", "measured", "proposed", "slack");
  for (const CalibratedMetric& metric : calibration.metrics) {
    const std::optional<double> slack = metric.slack();
    text += fmt::format("  {:<40} {:>26} {:>18} {:>26} {:>7}  {}", metric.metric, limits_text(metric.present),
                        range_text(metric), limits_text(metric.proposed), slack ? fmt::format("{:.1f}", *slack) : "",
                        change_of(metric));
    text.erase(text.find_last_not_of(' ') + 1);
    text += "\n";
  }
  return text;
}

}  // namespace patrol::app
