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
  std::string_view metrics;  ///< beginning of their names
  const char* topic;
  bool is_of_every_stack;  ///< false: of stacks with the sensor or the method
  bool (*is_published)(const score::RunRecord& record);
};

/// The group of each metric is the first whose name it begins with.
constexpr std::array kScoredTopics = std::to_array<ScoredTopic>({
    {"odometry.", io::kTopic<OdometryEstimate>, true,
     [](const score::RunRecord& record) { return !record.T_odom_body.empty(); }},
    {"map.", io::kTopic<MapUpdate>, true, [](const score::RunRecord& record) { return record.has_map(); }},
    {"mission.completed", io::kTopic<Event>, true,
     [](const score::RunRecord& record) { return !record.events.empty(); }},
    {"inspection.", io::kTopic<Event>, true, [](const score::RunRecord& record) { return !record.events.empty(); }},
    {"navigation.paths", io::kTopic<Path>, true, [](const score::RunRecord& record) { return record.num_paths > 0; }},
    {"localization.", io::kTopic<LocalizationConfidence>, false,
     [](const score::RunRecord& record) { return !record.confidences.empty(); }},
    {"range_pose.", io::kTopic<UwbPoseEstimate>, false,
     [](const score::RunRecord& record) { return !record.T_map_body_by_ranges.empty(); }},
    {"calibration.", io::kTopic<CalibrationEstimate>, false,
     [](const score::RunRecord& record) { return record.calibration.has_value(); }},
    {"", io::kTopic<PoseEstimate>, true, [](const score::RunRecord& record) { return !record.T_map_body.empty(); }},
});

/// Returns whether metrics.json states that the stack did not publish a topic.
bool is_unpublished(const io::Metrics& metrics, const char* topic) {
  const auto published = metrics.find("published_topics");
  return published != metrics.end() && std::ranges::find(*published, topic) == published->end();
}

/// Explanation of a metric that the run did not measure.
std::string reason_for_none(const std::string& metric, const io::Metrics& metrics) {
  for (const ScoredTopic& scored : kScoredTopics) {
    if (metric.starts_with(scored.metrics) && is_unpublished(metrics, scored.topic))
      return fmt::format("not published: {}", scored.topic);
  }
  return kNotMeasured;
}

constexpr double kMinMapCoverage = 0.5;

/// Adds the coverage that a bound of the map's error presumes.
io::Expectations with_map_coverage(io::Expectations expectations) {
  const auto is_map_error = [](const auto& entry) { return entry.first.starts_with("map.nearest_"); };
  if (std::ranges::any_of(expectations, is_map_error))
    expectations.try_emplace("map.coverage", io::Expectation{.min = kMinMapCoverage});
  return expectations;
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
      // Without events, a mission counts as not completed.
      const bool is_unknown = metric == "mission.completed" && *value < 0.5 && check.got != kNotMeasured;
      if (!is_unknown)
        check.got = expectation.is_boolean ? (*value > 0.5 ? "true" : "false") : fmt::format("{:.4g}", *value);
    }
    checks.push_back(check);
  }
  return checks;
}

std::vector<std::string> published_topics(const score::RunRecord& record) {
  std::vector<std::string> topics;
  for (const ScoredTopic& scored : kScoredTopics) {
    const bool is_listed = std::ranges::find(topics, scored.topic) != topics.end();
    if (!is_listed && scored.is_published(record)) topics.emplace_back(scored.topic);
  }
  return topics;
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

void check_expected_metrics(const io::Expectations& expectations, const io::SettingsSource& source) {
  for (const auto& [metric, expectation] : expectations) {
    int line = 0;
    if (!find_metric_info(metric) && std::filesystem::is_regular_file(source.file))
      line = io::line_of(find_node(io::load_document(source.file, {}), {"expect", metric}));
    check_metric(source.location(line, "expect." + metric), metric);
  }
}

bool all_met(const std::vector<CheckedExpectation>& checks) {
  return std::all_of(checks.begin(), checks.end(), [](const CheckedExpectation& check) { return check.is_met; });
}

}  // namespace patrol::app
