#include "app/report/verdict.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/run/run_verdict.h"
#include "app/scoring/expectations.h"
#include "core/text.h"

namespace patrol::app {
namespace {

using report::Tone;

const io::JunitCase* case_named(const RunContents& run, const std::string& name) {
  const auto found =
      std::find_if(run.cases.begin(), run.cases.end(), [&](const io::JunitCase& test) { return test.name == name; });
  return found == run.cases.end() ? nullptr : &*found;
}

/// Reason why the run ended before the mission was completed; empty if it did not.
std::string early_end(const RunContents& run) {
  const io::JunitCase* end = case_named(run, "run");
  return end == nullptr || end->result == io::JunitResult::kPassed ? "" : end->message;
}

report::TableCell trigger_cell(bool was_triggered) {
  return was_triggered ? report::TableCell{"triggered", Tone::kGood}
                       : report::TableCell{"not triggered", Tone::kWarning};
}

std::vector<report::TableCell> expectation_row(const CheckedExpectation& check, bool is_complete) {
  const report::TableCell result =
      check.is_met ? report::TableCell{"met", Tone::kGood} : report::TableCell{"MISSED", Tone::kBad};
  return {
      {check.metric}, {check.wanted}, {check.got}, is_complete ? result : report::TableCell{"unknown", Tone::kFaint}};
}

std::vector<report::TableCell> fault_row(const RunContents& run, const sim::FaultSettings& fault) {
  const std::string name = name_of(fault);
  const io::JunitCase* test = case_named(run, name);
  const report::TableCell result = test == nullptr ? report::TableCell{"unknown", Tone::kFaint}
                                                   : trigger_cell(test->result == io::JunitResult::kPassed);
  return {{name}, {fmt::format("{} s long", fault.duration_s)}, {test == nullptr ? "" : test->message}, result};
}

std::vector<report::TableCell> kidnap_row(const RunContents& run, const KidnapSettings& kidnap) {
  return {{name_of(kidnap)},
          {fmt::format("to ({}, {}) m", kidnap.x_m, kidnap.y_m)},
          {},
          trigger_cell(was_triggered(kidnap, run.record.T_world_body))};
}

std::string missed_text(const std::vector<CheckedExpectation>& checks) {
  std::vector<std::string> texts;
  for (const CheckedExpectation& check : checks) {
    if (!check.is_met) texts.push_back(describe_missed(check));
  }
  if (texts.empty()) return "";
  return fmt::format("{} of {} expectations missed: {}.", texts.size(), checks.size(), join(texts, "; "));
}

/// Fills in verdict, tone and reason of a complete run.
void fill_verdict(const RunContents& run, const std::vector<CheckedExpectation>& checks,
                  report::VerdictBlock& verdict) {
  const std::string end = early_end(run), misses = missed_text(checks);
  const bool is_passed = end.empty() && status_of(RunEnd::kMissionOver, checks) == RunStatus::kDone;
  verdict.word = is_passed ? "Passed" : "Missed";
  verdict.tone = is_passed ? Tone::kGood : Tone::kBad;
  if (!end.empty()) verdict.reason = fmt::format("The run ended early: {}.", end);
  if (!misses.empty()) verdict.reason += (verdict.reason.empty() ? "" : " ") + misses;
  if (!is_passed) return;
  verdict.reason = checks.empty()       ? "Run completed; the scenario defines no expectations."
                   : checks.size() == 1 ? "Run completed; its expectation was met."
                                        : fmt::format("Run completed; all {} expectations were met.", checks.size());
}

void add_untriggered(report::VerdictBlock& verdict) {
  const auto is_untriggered = [](const std::vector<report::TableCell>& row) {
    return row.back().tone == Tone::kWarning;
  };
  const auto num = std::count_if(verdict.checks.rows.begin(), verdict.checks.rows.end(), is_untriggered);
  if (num > 0)
    verdict.reason +=
        fmt::format(" {} declared, but not triggered.",
                    num == 1 ? "One fault or kidnap was" : fmt::format("{} faults and kidnaps were", num));
}

}  // namespace

bool was_triggered(const KidnapSettings& kidnap, const Trajectory& T_world_body) {
  constexpr double kNear_m = 0.5;                         // the robot may fall or roll a little
  constexpr Time kAfter = std::chrono::milliseconds(50);  // a few samples of the ground truth
  const std::optional<Pose3> truth = pose_at(T_world_body, from_seconds(kidnap.at_s) + kAfter);
  return truth && (truth->position.head<2>() - Eigen::Vector2d(kidnap.x_m, kidnap.y_m)).norm() < kNear_m;
}

report::VerdictBlock verdict_of(const RunContents& run) {
  report::VerdictBlock verdict;
  verdict.checks.columns = {{"declared"}, {"wanted", true}, {"got", true}, {"result"}};
  const std::vector<CheckedExpectation> checks = check_expectations(run.scenario.expect, run.metrics);
  for (const CheckedExpectation& check : checks) verdict.checks.rows.push_back(expectation_row(check, run.is_complete));
  for (const sim::FaultSettings& fault : run.scenario.faults) verdict.checks.rows.push_back(fault_row(run, fault));
  for (const KidnapSettings& kidnap : run.scenario.kidnaps) verdict.checks.rows.push_back(kidnap_row(run, kidnap));
  if (run.is_complete) {
    fill_verdict(run, checks, verdict);
  } else {
    verdict.word = "INCOMPLETE";
    verdict.tone = Tone::kBad;
    verdict.reason =
        fmt::format("Incomplete run: the log ends after {:.1f} s. Partial data only; not a valid result.", run.end_s());
  }
  add_untriggered(verdict);
  return verdict;
}

}  // namespace patrol::app
