#include "app/report/run_summary.h"

#include <algorithm>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "app/report/metric_blocks.h"
#include "app/scoring/goal_table.h"
#include "app/scoring/metric_lines.h"
#include "app/scoring/score_table.h"
#include "core/text.h"
#include "io/logs/topics.h"

namespace patrol::app {
namespace {

constexpr std::size_t kMaxExpectations = 8;
constexpr std::size_t kMaxKeyMetrics = 10;
constexpr std::size_t kMinValueWidth = 12;

std::size_t num_met(const std::vector<CheckedExpectation>& checks) {
  return static_cast<std::size_t>(
      std::count_if(checks.begin(), checks.end(), [](const CheckedExpectation& check) { return check.is_met; }));
}

/// "street/short, seed 1: done, 13 of 13 expectations met".
std::string status_line(const std::string& title, const RunVerdict& verdict, TextStyle style) {
  std::string status = colored(std::string(name_of(verdict.end)), verdict.code() == ExitCode::kDone, style);
  const bool has_own_message = verdict.end != RunStatus::kExpectationMissed && !verdict.message.empty();
  if (has_own_message) status += fmt::format(" ({})", verdict.message);
  if (verdict.checks.empty()) return fmt::format("{}: {}, no expectations\n", title, status);
  return fmt::format("{}: {}, {} of {} expectations met\n", title, status, num_met(verdict.checks),
                     verdict.checks.size());
}

/// The missed expectations first, then the others, as many as fit.
std::string expectation_lines(const std::vector<CheckedExpectation>& checks, TextStyle style) {
  std::vector<CheckedExpectation> sorted = checks;
  std::stable_partition(sorted.begin(), sorted.end(), [](const CheckedExpectation& check) { return !check.is_met; });
  const std::span<const CheckedExpectation> shown(sorted.data(), std::min(sorted.size(), kMaxExpectations));
  std::size_t got_width = kMinValueWidth;
  for (const CheckedExpectation& check : shown) got_width = std::max(got_width, check.got.size());
  std::string text;
  for (const CheckedExpectation& check : shown) {
    text += fmt::format("  {:<44} {:>{}}  {:<18} {}\n", check.metric, check.got, got_width, check.wanted,
                        met_text(check.is_met, style));
  }
  if (sorted.size() > kMaxExpectations) {
    const std::vector<CheckedExpectation> rest(sorted.begin() + kMaxExpectations, sorted.end());
    const std::size_t num_missed = rest.size() - num_met(rest);
    text += fmt::format("  {} further expectations: {}\n", rest.size(),
                        num_missed == 0 ? "met" : fmt::format("{} missed", num_missed));
  }
  return text;
}

std::string key_metric_lines(const io::Metrics& metrics) {
  std::string text;
  const std::vector<report::KeyMetric> rows = key_metrics(metrics).metrics;
  for (std::size_t i = 0; i < std::min(rows.size(), kMaxKeyMetrics); ++i) {
    const report::KeyMetric& row = rows[i];
    const std::string value = row.unit.empty() ? row.value : fmt::format("{} {}", row.value, row.unit);
    text += row.note.empty() ? fmt::format("  {:<36} {:>12}\n", row.label, value)
                             : fmt::format("  {:<36} {:>12}  {}\n", row.label, value, row.note);
  }
  return text;
}

std::string unpublished_line(const io::Metrics& metrics) {
  const std::vector<std::string> topics = unpublished_topics(metrics);
  return (topics.empty() ? "" : fmt::format("not published by the stack: {}\n", join(topics, ", "))) +
         (has_empty_map(metrics) ? fmt::format("published without occupied cells: {}\n", io::kTopic<MapUpdate>) : "");
}

std::string untriggered_line(const std::vector<InjectedEvent>& events) {
  std::vector<std::string> names;
  for (const InjectedEvent& event : events) {
    if (!event.was_triggered) names.push_back(event.name);
  }
  return names.empty() ? "" : fmt::format("not triggered: {}\n", join(names, ", "));
}

}  // namespace

std::string run_summary(const std::string& title, const RunVerdict& verdict, const std::filesystem::path& directory,
                        TextStyle style) {
  std::string text = status_line(title, verdict, style);
  for (const std::string& part : {expectation_lines(verdict.checks, style), key_metric_lines(verdict.metrics),
                                  unpublished_line(verdict.metrics) + untriggered_line(verdict.events) +
                                      fmt::format("{} metrics: {}; all with option --all; page: patrol report {}\n",
                                                  metric_lines(verdict.metrics).size(),
                                                  (directory / "metrics.json").string(), directory.string())}) {
    if (!part.empty()) text += "\n" + part;
  }
  return text;
}

std::string run_details(const std::string& title, const RunVerdict& verdict, const std::filesystem::path& directory,
                        TextStyle style) {
  std::string text = status_line(title, verdict, style);
  text += "\n" + score_table(verdict.metrics, verdict.checks, style) + "\n";
  if (const std::string goals = goal_table(verdict.metrics); !goals.empty()) text += goals + "\n";
  for (const InjectedEvent& event : verdict.events)
    text += fmt::format("{}: {}\n", event.name, event.was_triggered ? "triggered" : "not triggered");
  return text + fmt::format("run directory: {}\n", directory.string());
}

io::Metrics run_json(const RunVerdict& verdict, const std::filesystem::path& directory) {
  io::Metrics json = to_json(verdict);
  json["directory"] = directory.string();
  return json;
}

}  // namespace patrol::app
