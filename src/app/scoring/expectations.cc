#include "app/scoring/expectations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "app/scenario/mounts.h"
#include "app/scoring/metric_infos.h"
#include "app/scoring/metric_subjects.h"
#include "core/error.h"
#include "io/logs/topics.h"
#include "io/yaml/settings_yaml.h"

namespace patrol::app {
namespace {

std::string describe_limits(const io::Expectation& expectation) {
  if (expectation.is_boolean) return expectation.min > 0.5 ? "true" : "false";
  const bool has_min = std::isfinite(expectation.min), has_max = std::isfinite(expectation.max);
  if (has_min && has_max && expectation.min == expectation.max) return fmt::format("= {}", expectation.min);
  if (has_min && has_max) return fmt::format("{} ... {}", expectation.min, expectation.max);
  return has_min ? fmt::format(">= {}", expectation.min) : fmt::format("<= {}", expectation.max);
}

constexpr const char* kNotMeasured = "not measured";

/// Messages of the stack that a group of metrics is computed from.
struct ScoredTopic {
  std::string_view metrics;  ///< pattern of their paths (matches_metric)
  const char* topic;
  bool is_of_every_stack;  ///< false: of stacks with the sensor or the method
  bool (*is_published)(const score::RunRecord& record);
  bool is_count = false;  ///< whether the metrics have the value 0 or false without a message
};

bool has_events(const score::RunRecord& record) { return !record.events.empty(); }
bool has_maps(const score::RunRecord& record) { return record.has_map() || record.has_empty_map; }

/// The group of each metric is the first whose pattern it matches.
constexpr std::array kScoredTopics = std::to_array<ScoredTopic>({
    {"odometry.*", io::kTopic<OdometryEstimate>, true,
     [](const score::RunRecord& record) { return !record.T_odom_body.empty(); }},
    {"map.*", io::kTopic<MapUpdate>, true, has_maps},
    {"stations.*map_error_m", io::kTopic<MapUpdate>, true, has_maps},
    {"mission.completed", io::kTopic<Event>, true, has_events},
    {"mission.reported_completed", io::kTopic<Event>, true, has_events, true},
    {"mission.false_arrivals", io::kTopic<Event>, true, has_events, true},
    {"mission.sensor_faults_noticed", io::kTopic<Event>, true, has_events, true},
    {"navigation.detours", io::kTopic<Event>, true, has_events, true},
    {"navigation.recoveries", io::kTopic<Event>, true, has_events, true},
    {"stations.*", io::kTopic<Event>, true, has_events, true},
    {"goals.*", io::kTopic<Event>, true, has_events, true},
    {"docking.*", io::kTopic<Event>, true, has_events, true},
    {"inspection.leaks_found", io::kTopic<Event>, true, has_events, true},
    {"inspection.false_alarms", io::kTopic<Event>, true, has_events, true},
    {"inspection.*", io::kTopic<Event>, true, has_events},
    {"navigation.paths", io::kTopic<Path>, true,
     [](const score::RunRecord& record) { return record.num_paths > 0 || record.has_empty_path; }, true},
    {"localization.*", io::kTopic<LocalizationConfidence>, false,
     [](const score::RunRecord& record) { return !record.confidences.empty(); }},
    {"range_pose.*", io::kTopic<UwbPoseEstimate>, false,
     [](const score::RunRecord& record) { return !record.T_map_body_by_ranges.empty(); }},
    {"calibration.*", io::kTopic<CalibrationEstimate>, false,
     [](const score::RunRecord& record) { return record.calibration.has_value(); }},
    {"*", io::kTopic<PoseEstimate>, true, [](const score::RunRecord& record) { return !record.T_map_body.empty(); }},
});

/// Returns whether metrics.json states that the stack did not publish a topic.
bool is_unpublished(const io::Metrics& metrics, const char* topic) {
  const auto published = metrics.find("published_topics");
  return published != metrics.end() && std::ranges::find(*published, topic) == published->end();
}

/// Explanation of a metric that the run did not measure.
std::string reason_for_none(const std::string& metric, const io::Metrics& metrics) {
  for (const ScoredTopic& scored : kScoredTopics) {
    if (matches_metric(scored.metrics, metric) && is_unpublished(metrics, scored.topic))
      return fmt::format("not published: {}", scored.topic);
  }
  const bool is_of_map = metric.starts_with("map.") || metric.ends_with("map_error_m");
  return is_of_map && has_empty_map(metrics) ? fmt::format("empty: {}", io::kTopic<MapUpdate>) : kNotMeasured;
}

/// Sets the counts without a message to null. `path`: of `value` in `metrics`.
void clear_counts(const std::string& path, io::Metrics& value, const io::Metrics& metrics) {
  const auto path_of = [&](const std::string& key) { return path.empty() ? key : path + "." + key; };
  if (value.is_object()) {
    for (auto& [key, child] : value.items()) clear_counts(path_of(key), child, metrics);
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) clear_counts(path_of(fmt::format("{}", i)), value[i], metrics);
  } else if (value.is_number() || value.is_boolean()) {
    const auto scored = std::ranges::find_if(
        kScoredTopics, [&](const ScoredTopic& candidate) { return matches_metric(candidate.metrics, path); });
    if (scored->is_count && is_unpublished(metrics, scored->topic)) value = nullptr;
  }
}

constexpr double kMinMapCoverage = 0.5;

/// Adds the coverage that a bound of the map's error presumes.
io::Expectations with_map_coverage(io::Expectations expectations) {
  const auto is_map_error = [](const auto& entry) { return entry.first.starts_with("map.nearest_"); };
  if (std::ranges::any_of(expectations, is_map_error))
    expectations.try_emplace("map.coverage", io::Expectation{.min = kMinMapCoverage});
  return expectations;
}

/// Metrics whose values depend on the mission or on the survey in its file.
constexpr std::array<std::string_view, 10> kMissionMetrics = {"stations.*",
                                                              "goals.*",
                                                              "docking.*",
                                                              "inspection.*",
                                                              "course.*",
                                                              "range_pose.*",
                                                              "calibration.uwb.anchor_*",
                                                              "navigation.clearance.keep_out_min_m",
                                                              "mission.distance_m",
                                                              "mission.duration_s"};

bool is_of_mission(const std::string& metric) {
  return std::ranges::any_of(kMissionMetrics,
                             [&](std::string_view pattern) { return matches_metric(pattern, metric); });
}

/// Returns whether an override sets the expectation of a metric, or all of them.
bool is_set(const std::string& metric, const std::vector<std::string>& overrides) {
  const std::string own = "expect." + metric + "=";
  return std::ranges::any_of(
      overrides, [&](const std::string& one) { return one.starts_with(own) || one.starts_with("expect="); });
}

}  // namespace

std::vector<CheckedExpectation> check_expectations(const io::Expectations& expectations, const io::Metrics& metrics) {
  std::vector<CheckedExpectation> checks;
  for (const auto& [metric, expectation] : with_map_coverage(expectations)) {
    CheckedExpectation check{
        .metric = metric, .wanted = describe_limits(expectation), .got = reason_for_none(metric, metrics)};
    if (const std::optional<double> value = io::metric_at(metrics, metric)) {
      check.is_measured = true;
      check.is_met = *value >= expectation.min && *value <= expectation.max;
      // Without events, a mission counts as not completed, which is not a measurement.
      const bool is_unknown =
          metric == "mission.completed" && *value < 0.5 && is_unpublished(metrics, io::kTopic<Event>);
      if (is_unknown) check.is_met = false;
      else check.got = expectation.is_boolean ? (*value > 0.5 ? "true" : "false") : fmt::format("{:.4g}", *value);
    }
    checks.push_back(check);
  }
  return checks;
}

void add_published_topics(const score::RunRecord& record, bool is_built_in, io::Metrics& metrics) {
  std::vector<std::string> topics;
  for (const ScoredTopic& scored : kScoredTopics) {
    const bool is_listed = std::ranges::find(topics, scored.topic) != topics.end();
    if (!is_listed && (scored.is_published(record) || (is_built_in && scored.is_count)))
      topics.emplace_back(scored.topic);
  }
  metrics["published_topics"] = topics;
  clear_counts("", metrics, io::Metrics{{"published_topics", topics}});
}

std::vector<std::string> unpublished_topics(const io::Metrics& metrics) {
  std::vector<std::string> topics;
  for (const ScoredTopic& scored : kScoredTopics) {
    const bool is_listed = std::ranges::find(topics, scored.topic) != topics.end();
    if (!is_listed && scored.is_of_every_stack && is_unpublished(metrics, scored.topic))
      topics.emplace_back(scored.topic);
  }
  return topics;
}

bool has_empty_map(const io::Metrics& metrics) {
  return !is_unpublished(metrics, io::kTopic<MapUpdate>) && io::metric_at(metrics, "map.occupied_cells") == 0.0;
}

void check_expected_metrics(const Scenario& scenario, const io::SettingsSource& source) {
  YAML::Node document;
  if (!scenario.expect.empty() && std::filesystem::is_regular_file(source.file))
    document = io::load_document(source.file, {});
  MetricSubjects subjects(scenario, source.file);
  for (const auto& [metric, expectation] : scenario.expect) {
    const std::string location =
        source.location(io::line_of(find_node(document, {"expect", metric})), "expect." + metric);
    check_metric(location, metric);
    const MetricInfo info = find_metric_info(metric).value();
    if (expectation.is_boolean && !info.is_boolean())
      throw InputError(fmt::format("{}must be a number or an interval {{min:, max:}}, not {}", location,
                                   expectation.min > 0.5 ? "true" : "false"));
    subjects.check(location, metric);
  }
}

std::vector<std::string> drop_mission_expectations(const std::vector<std::string>& overrides,
                                                   io::Expectations& expectations) {
  std::vector<std::string> dropped;
  std::erase_if(expectations, [&](const auto& entry) {
    const std::string& metric = entry.first;
    const bool is_known = find_metric_info(metric).has_value();  // others are refused by check_expected_metrics
    const bool is_dropped = is_known && is_of_mission(metric) && !is_set(metric, overrides);
    if (is_dropped) dropped.push_back(metric);
    return is_dropped;
  });
  return dropped;
}

bool all_met(const std::vector<CheckedExpectation>& checks) {
  return std::all_of(checks.begin(), checks.end(), [](const CheckedExpectation& check) { return check.is_met; });
}

}  // namespace patrol::app
