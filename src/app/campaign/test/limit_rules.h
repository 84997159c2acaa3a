#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/named_table.h"
#include "io/yaml/expectations.h"

namespace patrol::app {

/// Rule by which the limits of an expectation follow from a metric's values over several seeds.
///
/// The upper limit of an error is twice the highest value. A run with a fixed seed repeats its bytes, so the distance
/// to the limit is room for later changes of the software, not for chance. The lower limit is a third of the lowest
/// value: an error far below every seed's means that a noise is off or that the truth leaks. The factor of three keeps
/// it out of the reach of chance. For the error of a single axis (density constant near zero), another seed is below a
/// third of the lowest of n with probability 1/(3(n+1)), 3 % for n = 10; for a distance in the plane with 1/(9(n+1));
/// for a mean over a run with far less.
enum class LimitRule : std::uint8_t { kError, kExtent, kFloor, kMaxCount, kMinCount, kTruth };

inline constexpr std::array kLimitRules = std::to_array<NamedValue<LimitRule>>({
    {LimitRule::kError, "error", "From a third of the lowest value to twice the highest"},
    {LimitRule::kExtent, "extent", "From 0.9 times the lowest value to 1.1 times the highest"},
    {LimitRule::kFloor, "floor", "At least 0.9 times the lowest value"},
    {LimitRule::kMaxCount, "max_count", "At most the highest value"},
    {LimitRule::kMinCount, "min_count", "At least the lowest value, if it is not zero"},
    {LimitRule::kTruth, "truth", "The value, if it is the same for all seeds"},
});
static_assert(is_in_order(kLimitRules));

/// Metrics with a rule other than the default, which is `kError`.
struct MetricRule {
  std::string_view pattern;  ///< path of the metric; `*` stands for one name or index
  LimitRule rule;
  bool is_standard;  ///< proposed for every scenario that measures it
};

inline constexpr std::array kMetricRules = std::to_array<MetricRule>({
    {"mission.completed", LimitRule::kTruth, true},
    {"mission.reported_completed", LimitRule::kTruth, false},
    {"mission.false_arrivals", LimitRule::kMaxCount, false},
    {"mission.fell", LimitRule::kTruth, false},
    {"mission.collisions", LimitRule::kMaxCount, true},
    {"mission.sensor_faults_noticed", LimitRule::kMaxCount, false},
    {"mission.distance_m", LimitRule::kExtent, true},
    {"mission.duration_s", LimitRule::kExtent, false},
    {"pose.ate_rmse_m", LimitRule::kError, true},
    {"pose.site.ate_rmse_m", LimitRule::kError, true},
    {"pose.heading_rmse_deg", LimitRule::kError, true},
    {"pose.aligned.rmse_m", LimitRule::kError, true},
    {"pose.nees.mean", LimitRule::kError, true},
    {"pose.nees.within_95", LimitRule::kFloor, true},
    {"pose.coverage", LimitRule::kFloor, true},
    {"calibration.within_95", LimitRule::kFloor, true},
    {"odometry.ate_rmse_m", LimitRule::kError, true},
    {"localization.max_error_m", LimitRule::kError, true},
    {"localization.min_trust", LimitRule::kFloor, false},
    {"map.nearest_mean_m", LimitRule::kError, true},
    {"map.coverage", LimitRule::kFloor, true},
    {"map.iou", LimitRule::kFloor, false},
    {"map.reference_agreement", LimitRule::kFloor, false},
    {"stations.*.map_error_m", LimitRule::kError, true},
    {"stations.*.site_map_error_m", LimitRule::kError, true},
    {"stations.*.reached", LimitRule::kTruth, false},
    {"goals.*.arrivals", LimitRule::kMinCount, true},
    {"goals.*.failed", LimitRule::kMaxCount, false},
    {"goals.*.position_error_m.mean", LimitRule::kError, true},
    {"goals.*.heading_error_deg.mean", LimitRule::kError, true},
    {"docking.arrivals", LimitRule::kMinCount, true},
    {"docking.failed", LimitRule::kMaxCount, false},
    {"docking.position_error_m.max", LimitRule::kError, true},
    {"docking.heading_error_deg.max", LimitRule::kError, true},
    {"navigation.clearance.*", LimitRule::kFloor, false},
    {"localizability.covariance_rank_correlation", LimitRule::kFloor, false},
    {"localizability.covariance_detection", LimitRule::kFloor, false},
    {"localizability.trust_rank_correlation", LimitRule::kFloor, false},
    {"localizability.trust_detection", LimitRule::kFloor, false},
    {"inspection.leaks_found", LimitRule::kMinCount, true},
    {"inspection.false_alarms", LimitRule::kMaxCount, false},
    {"inspection.lining.registered", LimitRule::kMinCount, true},
    {"inspection.lining.missed", LimitRule::kMaxCount, false},
    {"inspection.lining.false_findings", LimitRule::kMaxCount, false},
    {"inspection.water.missed", LimitRule::kMaxCount, false},
    {"inspection.water.false_alarms", LimitRule::kMaxCount, false},
});

/// Index of the metric's first rule in kMetricRules; the size of the table if it has none.
std::size_t rule_index(std::string_view metric);
LimitRule rule_of(std::string_view metric);
bool is_standard(std::string_view metric);

/// Limits by a rule, errors with two significant digits, extents with three. An upper limit of an error is rounded
/// down, so that it is at most twice the highest value. None if the rule gives no limit. `values`: at least one.
std::optional<io::Expectation> limits_of(LimitRule rule, const std::vector<double>& values);

/// Both limits of each end, the narrower one.
io::Expectation narrower(const io::Expectation& a, const io::Expectation& b);
/// Whether `proposed` allows a value that `present` refuses.
bool is_wider(const io::Expectation& proposed, const io::Expectation& present);

/// Expectation as it is written in a scenario: "true", "0.5", "{min: 0.001, max: 0.02}".
std::string to_yaml(const io::Expectation& expectation);

}  // namespace patrol::app
