#include "app/report/test_page.h"

#include <algorithm>

#include <fmt/format.h>

namespace patrol::app {
namespace {

using report::Tone;

report::TableBlock scenario_table(const std::vector<TestedScenario>& tested, bool are_passed) {
  report::TableBlock table{.caption = "", .columns = {{"result"}, {"scenario"}, {"s", true}, {"why"}}, .rows = {}};
  for (const TestedScenario& one : tested) {
    if (is_passed(one) != are_passed) continue;
    const auto seconds = io::metric_at(one.verdict->metrics, "performance.wall_s");
    table.rows.push_back({are_passed ? report::TableCell{"passed", Tone::kGood} : report::TableCell{std::string(name_of(one.verdict->end)), Tone::kBad},
                          {one.name},
                          {seconds ? fmt::format("{:.1f}", *seconds) : ""},
                          {one.verdict->message}});
  }
  return table;
}

/// Tables of the scenarios with expectations.
report::CollapsibleTables expectation_tables(const std::vector<TestedScenario>& tested) {
  report::CollapsibleTables folded{.summary = "What was expected, and what was measured", .tables = {}};
  for (const TestedScenario& one : tested) {
    if (one.verdict->checks.empty()) continue;
    report::TableBlock table{.caption = one.name, .columns = {{"metric"}, {"wanted", true}, {"got", true}, {""}}, .rows = {}};
    for (const CheckedExpectation& check : one.verdict->checks) {
      table.rows.push_back({{check.metric}, {check.wanted}, {check.got}, check.is_met ? report::TableCell{"met", Tone::kGood} : report::TableCell{"MISSED", Tone::kBad}});
    }
    folded.tables.push_back(std::move(table));
  }
  return folded;
}

}  // namespace

report::Page test_page(const std::vector<TestedScenario>& tested) {
  const auto num_passed = std::count_if(tested.begin(), tested.end(), is_passed);
  const bool are_all = num_passed == static_cast<std::ptrdiff_t>(tested.size());
  report::VerdictBlock verdict{.word = are_all ? "Passed" : fmt::format("{} of {} failed", tested.size() - static_cast<std::size_t>(num_passed), tested.size()),
                               .tone = are_all ? Tone::kGood : Tone::kBad,
                               .reason = are_all ? fmt::format("All {} scenarios met what they expect.", tested.size()) : "",
                               .checks = are_all ? report::TableBlock{} : scenario_table(tested, false)};
  report::Page page{.kind = "report of a test",
                    .title = fmt::format("{} scenarios", tested.size()),
                    .facts = {{"patrol", PATROL_VERSION}},
                    .sections = {{.title = "", .blocks = {verdict}}},
                    .footer = "Made by patrol test. The same verdicts stand in junit.xml, and every figure in tests.csv."};
  if (num_passed > 0) page.sections.push_back({"Passed", {scenario_table(tested, true)}});
  if (const report::CollapsibleTables folded = expectation_tables(tested); !folded.tables.empty()) page.sections.push_back({"Expectations", {folded}});
  return page;
}

}  // namespace patrol::app
