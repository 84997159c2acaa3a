#include "app/run_junit.h"

#include <fmt/format.h>

#include "io/junit.h"

namespace patrol::app {
namespace {

std::vector<std::pair<std::string, std::string>> properties_of(const Scenario& scenario) {
  return {{"world", scenario.world},
          {"robot", scenario.robot},
          {"mission", scenario.mission},
          {"seed", fmt::format("{}", scenario.seed)},
          {"version", PATROL_VERSION}};
}

io::JunitCase end_case(const std::string& name, const RunOutcome& outcome) {
  io::JunitCase test{.class_name = name, .name = "run", .time_s = outcome.wall_s, .result = io::JunitResult::kPassed,
                     .message = "", .details = ""};
  if (outcome.end == RunEnd::kMissionOver) return test;
  test.result = io::JunitResult::kFailure;
  test.message = outcome.end == RunEnd::kFall ? fmt::format("the robot fell at {:.2f} s", to_seconds(outcome.duration))
                                              : fmt::format("time limit: {:.0f} s", to_seconds(outcome.duration));
  return test;
}

io::JunitCase expectation_case(const std::string& name, const CheckedExpectation& check) {
  return {.class_name = name,
          .name = fmt::format("{} {}", check.metric, check.wanted),
          .time_s = 0.0,
          .result = check.is_met ? io::JunitResult::kPassed : io::JunitResult::kFailure,
          .message = check.is_met ? "" : fmt::format("{} is {}, expected {}", check.metric, check.got, check.wanted),
          .details = ""};
}

io::JunitCase fault_case(const std::string& name, const sim::FaultReport& report) {
  return {.class_name = name,
          .name = "fault " + describe(report.fault),
          .time_s = 0.0,
          .result = report.is_executed ? io::JunitResult::kPassed : io::JunitResult::kSkipped,
          .message = report.is_executed ? "" : "NOT EXECUTED: no message was touched",
          .details = ""};
}

}  // namespace

std::string describe(const sim::FaultSettings& fault) {
  return fmt::format("{} {} at {} s", fault.sensor, fault.kind, fault.start_s);
}

void write_unfinished_junit(const RunDirectory& directory, const Scenario& scenario, const std::string& name) {
  io::JunitSuite suite = io::unfinished_junit(name);
  suite.properties = properties_of(scenario);
  io::save_junit(directory.junit(), {suite});
}

void write_junit(const RunDirectory& directory, const Scenario& scenario, const std::string& name, const RunOutcome& outcome,
                 const std::vector<CheckedExpectation>& checks) {
  io::JunitSuite suite{.name = name, .time_s = outcome.wall_s, .properties = properties_of(scenario), .cases = {}};
  suite.cases.push_back(end_case(name, outcome));
  for (const CheckedExpectation& check : checks) suite.cases.push_back(expectation_case(name, check));
  for (const sim::FaultReport& fault : outcome.faults) suite.cases.push_back(fault_case(name, fault));
  io::save_junit(directory.junit(), {suite});
}

}  // namespace patrol::app
