#include "app/run/run_verdict.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

namespace patrol::app {
namespace {

std::vector<InjectedEvent> events_of(const RunOutcome& outcome, const std::vector<KidnapSettings>& kidnaps) {
  std::vector<InjectedEvent> events;
  for (const sim::FaultStatus& report : outcome.faults) {
    events.push_back({.name = name_of(report.fault), .was_triggered = report.was_triggered});
  }
  for (auto kidnap = kidnaps.begin(); kidnap != kidnaps.end(); ++kidnap) {
    const auto is_earlier = [&](const KidnapSettings& other) { return other.at_s < kidnap->at_s; };
    const auto is_same = [&](const KidnapSettings& other) { return other.at_s == kidnap->at_s; };
    const auto num_before = static_cast<std::size_t>(std::count_if(kidnaps.begin(), kidnaps.end(), is_earlier) +
                                                     std::count_if(kidnaps.begin(), kidnap, is_same));
    events.push_back({.name = name_of(*kidnap), .was_triggered = num_before < outcome.num_kidnaps});
  }
  return events;
}

}  // namespace

std::string name_of(const sim::FaultSettings& fault) {
  return fmt::format("fault {} {} at {} s", fault.sensor, fault.kind, fault.start_s);
}
std::string name_of(const KidnapSettings& kidnap) { return fmt::format("kidnap at {} s", kidnap.at_s); }

RunStatus status_of(RunEnd end, const std::vector<CheckedExpectation>& checks) {
  if (end == RunEnd::kFall) return RunStatus::kFall;
  if (end == RunEnd::kTimeLimit) return RunStatus::kTimeLimit;
  if (end == RunEnd::kStackFailed) return RunStatus::kStackFailed;
  if (end == RunEnd::kStackSilent) return RunStatus::kStackSilent;
  return all_met(checks) ? RunStatus::kDone : RunStatus::kExpectationMissed;
}

RunVerdict verdict_of(const RunOutcome& outcome, const std::vector<KidnapSettings>& kidnaps, io::Metrics metrics,
                      std::vector<CheckedExpectation> checks) {
  const RunStatus end = status_of(outcome.end, checks);
  RunVerdict verdict{.end = end,
                     .message = "",
                     .metrics = std::move(metrics),
                     .checks = std::move(checks),
                     .events = events_of(outcome, kidnaps)};
  for (const CheckedExpectation& check : verdict.checks) {
    if (!check.is_met) verdict.message += (verdict.message.empty() ? "" : "; ") + describe_missed(check);
  }
  if (verdict.end == RunStatus::kFall) {
    verdict.message = fmt::format("the robot fell at {:.2f} s", to_seconds(outcome.duration));
  } else if (verdict.end == RunStatus::kTimeLimit) {
    verdict.message = fmt::format("{:g} s", to_seconds(outcome.duration));
  } else if (!outcome.stack_failure.empty()) {
    verdict.message = outcome.stack_failure;
  }
  return verdict;
}

std::string describe_missed(const CheckedExpectation& check) {
  return fmt::format("{} is {}, expected {}", check.metric, check.got, check.wanted);
}

io::Metrics to_json(const RunVerdict& verdict) {
  io::Metrics json{{"end", name_of(verdict.end)},    {"exit_code", static_cast<int>(verdict.code())},
                   {"message", verdict.message},     {"expectations", io::Metrics::array()},
                   {"events", io::Metrics::array()}, {"metrics", verdict.metrics}};
  for (const CheckedExpectation& check : verdict.checks) {
    json["expectations"].push_back({{"metric", check.metric},
                                    {"wanted", check.wanted},
                                    {"got", check.got},
                                    {"is_measured", check.is_measured},
                                    {"is_met", check.is_met}});
  }
  for (const InjectedEvent& event : verdict.events) {
    json["events"].push_back({{"name", event.name}, {"was_triggered", event.was_triggered}});
  }
  return json;
}

RunVerdict verdict_from_json(const io::Metrics& json) {
  RunVerdict verdict{.end = row_named(kRunStatuses, json.at("end").get<std::string>(), "end").value,
                     .message = json.at("message"),
                     .metrics = json.at("metrics"),
                     .checks = {},
                     .events = {}};
  for (const io::Metrics& check : json.at("expectations")) {
    verdict.checks.push_back({.metric = check.at("metric"),
                              .wanted = check.at("wanted"),
                              .got = check.at("got"),
                              .is_measured = check.at("is_measured"),
                              .is_met = check.at("is_met")});
  }
  for (const io::Metrics& event : json.at("events")) {
    verdict.events.push_back({.name = event.at("name"), .was_triggered = event.at("was_triggered")});
  }
  return verdict;
}

}  // namespace patrol::app
