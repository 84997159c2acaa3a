#include "app/scoring/score_table.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "app/scoring/metric_lines.h"

namespace patrol::app {
namespace {

/// Table with one line per metric: "  pose.ate_rmse_m            0.0712  <= 0.15  met".
class Table {
 public:
  Table(const std::vector<CheckedExpectation>& checks, TextStyle style) : checks_(checks), style_(style) {}

  void add(const MetricLine& metric) {
    const auto check = std::find_if(checks_.begin(), checks_.end(), [&](const CheckedExpectation& candidate) {
      return candidate.metric == metric.path;
    });
    text_ += line(metric.path, metric.text, check == checks_.end() ? nullptr : &*check);
    shown_.insert(metric.path);
  }

  /// Adds the expectations of metrics without a line: not measured, or indexed in a list.
  void add_rest() {
    for (const CheckedExpectation& check : checks_) {
      if (!shown_.contains(check.metric)) text_ += line(check.metric, check.got, &check);
    }
  }

  const std::string& text() const { return text_; }

 private:
  std::string line(const std::string& path, const std::string& value, const CheckedExpectation* check) {
    const std::string group = path.substr(0, path.find('.'));
    const std::string gap = group == group_ ? "" : "\n";
    group_ = group;
    const std::string verdict =
        check == nullptr ? "" : fmt::format("  {:<14} {}", check->wanted, met_text(check->is_met, style_));
    return fmt::format("{}  {:<44} {:>12}{}\n", gap, path, value, verdict);
  }

  const std::vector<CheckedExpectation>& checks_;
  TextStyle style_;
  std::string text_;
  std::string group_;
  std::set<std::string> shown_;  ///< paths of the metrics shown
};

}  // namespace

std::string score_table(const io::Metrics& metrics, const std::vector<CheckedExpectation>& checks, TextStyle style) {
  Table table(checks, style);
  for (const MetricLine& metric : metric_lines(metrics)) table.add(metric);
  table.add_rest();
  return table.text();
}

}  // namespace patrol::app
