#include "app/run/run_junit.h"

#include <algorithm>

#include <fmt/format.h>

namespace patrol::app {
namespace {

constexpr const char* kEndCase = "run";  ///< name of the case for the end of a run

/// Beginning of the message of an end, if it names the status.
std::string status_prefix(RunStatus status) { return fmt::format("{}: ", name_of(status)); }

io::JunitCase end_case(const std::string& name, const RunVerdict& verdict, double time_s) {
  io::JunitCase test{.class_name = name,
                     .name = kEndCase,
                     .time_s = time_s,
                     .result = io::JunitResult::kPassed,
                     .message = "",
                     .details = ""};
  if (verdict.end == RunStatus::kDone || verdict.end == RunStatus::kExpectationMissed) return test;  // own cases
  const bool is_stack_failure = verdict.end == RunStatus::kStackFailed || verdict.end == RunStatus::kStackSilent;
  const bool came_to_a_score = !verdict.metrics.empty() && !is_stack_failure;
  const bool has_whole_message = came_to_a_score && verdict.end != RunStatus::kTimeLimit;
  test.result = came_to_a_score ? io::JunitResult::kFailure : io::JunitResult::kError;
  test.message = has_whole_message ? verdict.message : status_prefix(verdict.end) + verdict.message;
  return test;
}

io::JunitCase expectation_case(const std::string& name, const CheckedExpectation& check) {
  return {.class_name = name,
          .name = fmt::format("{} {}", check.metric, check.wanted),
          .time_s = 0.0,
          .result = check.is_met ? io::JunitResult::kPassed : io::JunitResult::kFailure,
          .message = check.is_met ? "" : describe_missed(check),
          .details = ""};
}

io::JunitCase event_case(const std::string& name, const InjectedEvent& event) {
  return {.class_name = name,
          .name = event.name,
          .time_s = 0.0,
          .result = event.was_triggered ? io::JunitResult::kPassed : io::JunitResult::kSkipped,
          .message = event.was_triggered ? "" : "not triggered",
          .details = ""};
}

}  // namespace

std::vector<std::pair<std::string, std::string>> junit_properties(const Scenario& scenario) {
  return {{"world", scenario.world},
          {"robot", scenario.robot},
          {"mission", scenario.mission},
          {"seed", fmt::format("{}", scenario.seed)},
          {"version", PATROL_VERSION}};
}

io::JunitSuite unfinished_suite(const std::string& name,
                                const std::vector<std::pair<std::string, std::string>>& properties) {
  io::JunitSuite suite = io::unfinished_junit(name);
  suite.properties = properties;
  return suite;
}

io::JunitSuite junit_suite(const std::string& name, const std::vector<std::pair<std::string, std::string>>& properties,
                           const RunVerdict& verdict) {
  const double wall_s = io::metric_at(verdict.metrics, "performance.wall_s").value_or(0.0);
  io::JunitSuite suite{.name = name, .time_s = wall_s, .properties = properties, .cases = {}};
  suite.cases.push_back(end_case(name, verdict, wall_s));
  for (const CheckedExpectation& check : verdict.checks) suite.cases.push_back(expectation_case(name, check));
  for (const InjectedEvent& event : verdict.events) suite.cases.push_back(event_case(name, event));
  return suite;
}

std::optional<EarlyEnd> load_early_end(const std::filesystem::path& junit_xml) {
  if (!std::filesystem::exists(junit_xml)) return std::nullopt;
  for (const io::JunitSuite& suite : io::load_junit(junit_xml)) {
    const auto end = std::ranges::find(suite.cases, kEndCase, &io::JunitCase::name);
    if (end == suite.cases.end() || end->result == io::JunitResult::kPassed) continue;
    for (const RunStatusRow& row : kRunStatuses) {
      const std::string prefix = status_prefix(row.value);
      if (end->message.starts_with(prefix)) return EarlyEnd{row.value, end->message.substr(prefix.size())};
    }
    const bool is_fall = end->result == io::JunitResult::kFailure;  // whose message does not begin with its status
    return EarlyEnd{is_fall ? RunStatus::kFall : RunStatus::kFailed, end->message};
  }
  return std::nullopt;
}

}  // namespace patrol::app
