#include "app/score_table.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

namespace patrol::app {
namespace {

/// One line a figure: "  pose.ate_rmse_m            0.0712  <= 0.15  met".
class Table {
 public:
  explicit Table(const std::vector<CheckedExpectation>& checks) : checks_(checks) {}

  void add(const std::string& path, const io::Metrics& value) {
    if (value.is_object()) {
      for (const auto& [key, child] : value.items()) add(path.empty() ? key : path + "." + key, child);
    } else if (value.is_array()) {
      for (std::size_t i = 0; i < value.size(); ++i) add_entry(path, i, value[i]);
    } else {
      add_line(path, value);
    }
  }

  /// What was expected of figures that have no line yet: not measured, or named by their place in a list.
  void add_rest() {
    for (const CheckedExpectation& check : checks_) {
      if (!shown_.contains(check.metric)) text_ += line(check.metric, check.got, &check);
    }
  }

  const std::string& text() const { return text_; }

 private:
  void add_entry(const std::string& path, std::size_t index, const io::Metrics& entry) {
    const bool is_named = entry.is_object() && entry.contains("name");
    io::Metrics rest = entry;
    if (is_named) rest.erase("name");
    add(path + "." + (is_named ? entry.at("name").get<std::string>() : fmt::format("{}", index)), rest);
  }

  void add_line(const std::string& path, const io::Metrics& value) {
    const auto check = std::find_if(checks_.begin(), checks_.end(),
                                    [&](const CheckedExpectation& candidate) { return candidate.metric == path; });
    text_ += line(path, shown(value), check == checks_.end() ? nullptr : &*check);
    shown_.insert(path);
  }

  static std::string shown(const io::Metrics& value) {
    if (value.is_null()) return "-";
    if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
    if (value.is_number_float()) return fmt::format("{:.4g}", value.get<double>());
    return value.is_string() ? value.get<std::string>() : value.dump();
  }

  std::string line(const std::string& path, const std::string& value, const CheckedExpectation* check) {
    const std::string group = path.substr(0, path.find('.'));
    const std::string gap = group == group_ ? "" : "\n";
    group_ = group;
    const std::string verdict = check == nullptr ? "" : fmt::format("  {:<14} {}", check->wanted, check->is_met ? "met" : "MISSED");
    return fmt::format("{}  {:<44} {:>12}{}\n", gap, path, value, verdict);
  }

  const std::vector<CheckedExpectation>& checks_;
  std::string text_;
  std::string group_;
  std::set<std::string> shown_;  ///< paths
};

}  // namespace

std::string score_table(const io::Metrics& metrics, const std::vector<CheckedExpectation>& checks) {
  Table table(checks);
  table.add("", metrics);
  table.add_rest();
  return table.text();
}

}  // namespace patrol::app
