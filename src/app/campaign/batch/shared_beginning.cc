#include "app/campaign/batch/shared_beginning.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <string>
#include <utility>

namespace patrol::app {
namespace {

/// Margin before the first event that differs, longer than a tick.
constexpr double kMargin_s = 0.02;

/// Faults or kidnaps, each alone as YAML, by time.
using Events = std::multimap<double, std::string>;

Events events_of(const Scenario& scenario) {
  Events events;
  for (const sim::FaultSettings& fault : scenario.faults) {
    Scenario alone;
    alone.faults = {fault};
    events.emplace(fault.start_s, to_yaml(alone));
  }
  for (const KidnapSettings& kidnap : scenario.kidnaps) {
    Scenario alone;
    alone.kidnaps = {kidnap};
    events.emplace(kidnap.at_s, to_yaml(alone));
  }
  return events;
}

/// Time of the first event that differs; infinite without one.
double first_difference_s(const Events& a, const Events& b) {
  auto next_a = a.begin(), next_b = b.begin();
  while (next_a != a.end() && next_b != b.end() && *next_a == *next_b) ++next_a, ++next_b;
  const double infinite = std::numeric_limits<double>::infinity();
  return std::min(next_a == a.end() ? infinite : next_a->first, next_b == b.end() ? infinite : next_b->first);
}

std::string without_events(Scenario scenario) {
  scenario.faults.clear();
  scenario.kidnaps.clear();
  scenario.expect.clear();
  return to_yaml(scenario);
}

bool can_be_saved(const Scenario& scenario) {
  return scenario.stack.command.empty() && scenario.stack.slam.method != "submap_rbpf" &&
         std::ranges::none_of(scenario.faults, [](const sim::FaultSettings& fault) {
           return fault.sensor == SensorTraits<PanoramicScan>::kInfo.name && fault.kind == "freeze";
         });
}

}  // namespace

std::vector<std::optional<SharedBeginning>> shared_beginnings(const std::vector<Scenario>& scenarios, double min_s) {
  std::map<std::string, std::size_t> leaders;
  std::vector<std::optional<SharedBeginning>> shared(scenarios.size());
  for (std::size_t i = 0; i < scenarios.size(); ++i) {
    if (!can_be_saved(scenarios[i])) continue;
    const auto [leader, is_first] = leaders.emplace(without_events(scenarios[i]), i);
    if (is_first) continue;
    const double first_s = first_difference_s(events_of(scenarios[leader->second]), events_of(scenarios[i]));
    if (first_s >= min_s && first_s <= scenarios[i].time_limit_s)
      shared[i] = {.leader = leader->second, .until = from_seconds(first_s - kMargin_s)};
  }
  return shared;
}

}  // namespace patrol::app
