#pragma once

#include <string>
#include <vector>

#include "app/scenario/scenario.h"
#include "io/json/metrics_json.h"
#include "io/yaml/expectations.h"
#include "score/run_record.h"

namespace patrol::io {
struct SettingsSource;
}

namespace patrol::app {

/// Result of one line of a scenario's `expect:` on metrics.json.
struct CheckedExpectation {
  std::string metric;
  std::string wanted;  ///< "<= 0.15", "true"
  std::string got;     ///< "0.07", "not measured", or "not published: /map"
  bool is_measured = false;
  bool is_met = false;
};

/// Checks all expectations. An expectation of a metric that the run did not measure is not met. A nearly empty map can
/// meet any bound of `map.nearest_*`: with such a bound and none of `map.coverage`, the coverage must be at least 0.5.
/// For a metric of a topic that the stack does not publish, `got` says so.
std::vector<CheckedExpectation> check_expectations(const io::Expectations& expectations, const io::Metrics& metrics);

/// Adds the topics with scored messages that the stack published, and sets counts of messages on other topics to null.
/// The built-in stack publishes `/events` and `/plan` whenever there is something to publish, so its counts can be 0.
void add_published_topics(const score::RunRecord& record, bool is_built_in, io::Metrics& metrics);
/// Topics with scored messages of every stack that the stack did not publish; empty if metrics.json does not list them.
std::vector<std::string> unpublished_topics(const io::Metrics& metrics);

/// Returns whether the map that the stack published has no occupied cell.
bool has_empty_map(const io::Metrics& metrics);

/// Throws InputError for an expectation of an unknown metric, station or calibration parameter, and for one of true or
/// false of a metric with numbers, with the place of the expectation. `source`: file and overrides of the scenario.
void check_expected_metrics(const Scenario& scenario, const io::SettingsSource& source);

/// Removes the expectations of a mission that goals of the command line replace: of its stations, goals, docking,
/// inspection and optimal time, its length, and what only its survey has (anchors, keep-out lines). Keeps those that
/// `overrides` set, which concern the goals. Returns the removed metrics.
std::vector<std::string> drop_mission_expectations(const std::vector<std::string>& overrides,
                                                   io::Expectations& expectations);

bool all_met(const std::vector<CheckedExpectation>& checks);

}  // namespace patrol::app
