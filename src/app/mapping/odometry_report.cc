#include "app/mapping/odometry_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace patrol::app {
namespace {

constexpr std::size_t kListedFaults = 20;  ///< places in metrics.json
constexpr std::size_t kShownFaults = 8;    ///< places on the page
/// More faulty segments than this are worth a warning; from kMostly on, a fault is named as a property of the log.
constexpr double kMaxFaulty = 0.05, kMostly = 0.5;
/// Fraction of scans without a match above which the path is mostly that of odometry.
constexpr double kMaxUnmatched = 0.5;
/// Scales further from 1, and a steering bias larger than this, are worth a warning.
constexpr double kMaxScaleError = 0.03, kMaxSteering_radpm = 0.02;
/// Smaller standard deviations are rounding errors: the path is that of odometry.
constexpr double kRounding = 1e-6;

using Distances = std::array<double, slam::kOdometryFaultNames.size()>;

Distances distances_by_fault(const slam::OdometryHealth& health) {
  Distances distances{};
  for (const slam::FaultyOdometry& entry : health.faulty)
    distances[static_cast<std::size_t>(entry.fault)] += entry.distance_m;
  return distances;
}

std::string fault_name(std::size_t fault) { return std::string(slam::kOdometryFaultNames[fault]); }
std::string fault_name(slam::OdometryFault fault) { return fault_name(static_cast<std::size_t>(fault)); }

bool is_off(const std::optional<slam::OdometryScale>& scale, double nominal, double limit) {
  return scale && std::abs(scale->value - nominal) > limit;
}

std::string text(const std::optional<slam::OdometryScale>& scale, const std::string& unit = "") {
  if (!scale) return "not determined";
  return fmt::format("{:.3f} ± {:.3f}{}", scale->value, scale->std, unit);
}

bool is_exactly(const std::optional<slam::OdometryScale>& scale, double value) {
  return !scale || (scale->std < kRounding && std::abs(scale->value - value) < kRounding);
}

/// Returns whether the mapped path is that of odometry, because the scans determine no motion.
bool is_path_of_odometry(const slam::OdometryHealth& health) {
  return (health.distance || health.turn) && health.num_faulty == 0 && is_exactly(health.distance, 1.0) &&
         is_exactly(health.turn, 1.0) && is_exactly(health.steering, 0.0);
}

io::Metrics to_metrics(const std::optional<slam::OdometryScale>& scale) {
  if (!scale) return nullptr;
  return {{"value", scale->value}, {"std", scale->std}};
}

}  // namespace

double OdometryReport::seconds(std::size_t scan) const { return to_seconds(stamps.at(scan) - stamps.front()); }

bool OdometryReport::is_mostly_unmatched() const {
  return static_cast<double>(num_unmatched_scans) > kMaxUnmatched * static_cast<double>(stamps.size());
}

MappingVerdict OdometryReport::verdict() const {
  if (health.num_segments == 0) {
    return {.word = "odometry not checked",
            .tone = report::Tone::kWarning,
            .reason = "it hardly moves, and neither does the robot in the map"};
  }
  if (static_cast<double>(num_frozen_scans) > kMaxFaulty * static_cast<double>(stamps.size())) {
    return {.word = "odometry not checked",
            .tone = report::Tone::kWarning,
            .reason = fmt::format("the lidar is frozen: {} of {} scans repeat the one before", num_frozen_scans,
                                  stamps.size())};
  }
  if (is_path_of_odometry(health)) {
    return {.word = "odometry not checked",
            .tone = report::Tone::kWarning,
            .reason = "the scans determine no motion, the path is that of odometry"};
  }
  if (is_mostly_unmatched()) {
    return {.word = "odometry not checked",
            .tone = report::Tone::kWarning,
            .reason = fmt::format("{} of {} scans matched no surfaces, the path there is that of odometry",
                                  num_unmatched_scans, stamps.size())};
  }
  const std::string scales = fmt::format("scale of distance {}, of turn {}, steering {}", text(health.distance),
                                         text(health.turn), text(health.steering, " rad per m"));
  std::vector<std::string> found;
  const Distances distances = distances_by_fault(health);
  if (health.faulty_ratio() > kMaxFaulty) {
    std::vector<std::string> kinds;
    for (std::size_t k = 0; k < distances.size(); ++k) {
      if (distances[k] > 0.0) kinds.push_back(fmt::format("{} {:.0f} m", fault_name(k), distances[k]));
    }
    found.push_back(fmt::format("{:.0f} % of the segments contradict the map ({})", 100.0 * health.faulty_ratio(),
                                fmt::join(kinds, ", ")));
  }
  if (health.delay_s != 0.0) {
    found.push_back(
        fmt::format("{} {:.2f} s", health.delay_s > 0.0 ? "late by" : "early by", std::abs(health.delay_s)));
  }
  const bool has_wrong_scale = is_off(health.distance, 1.0, kMaxScaleError) ||
                               is_off(health.turn, 1.0, kMaxScaleError) ||
                               is_off(health.steering, 0.0, kMaxSteering_radpm);
  const auto main_fault = std::max_element(distances.begin(), distances.end());
  MappingVerdict verdict{.word = "odometry agrees", .tone = report::Tone::kGood, .reason = ""};
  const auto warn = [&](const std::string& word) {
    verdict.word = word;
    verdict.tone = report::Tone::kWarning;
  };
  if (*main_fault > kMostly * health.distance_m) {
    warn("odometry is mostly " + fault_name(static_cast<std::size_t>(main_fault - distances.begin())));
  } else if (!found.empty()) {
    warn("odometry has faults");
  } else if (has_wrong_scale) {
    warn("odometry is not calibrated");
  } else if (!health.distance && !health.turn) {
    warn("odometry not checked");
  }
  found.push_back(scales);
  if (health.num_gaps > 0) {
    found.push_back(fmt::format("{} gaps between scans, at most {:.1f} s, at {:.0f} s", health.num_gaps,
                                health.max_gap_s, seconds(health.max_gap_scan)));
  }
  verdict.reason = fmt::format("{}", fmt::join(found, "; "));
  return verdict;
}

std::string OdometryReport::line() const { return verdict().line(); }

io::Metrics OdometryReport::metrics() const {
  io::Metrics listed = io::Metrics::array();
  for (std::size_t i = 0; i < std::min(kListedFaults, health.faulty.size()); ++i) {
    const slam::FaultyOdometry& entry = health.faulty[i];
    listed.push_back({{"fault", fault_name(entry.fault)},
                      {"from_s", seconds(entry.first_scan)},
                      {"x_m", entry.p_map.x()},
                      {"y_m", entry.p_map.y()},
                      {"distance_m", entry.distance_m}});
  }
  io::Metrics by_fault;
  const Distances distances = distances_by_fault(health);
  for (std::size_t k = 0; k < distances.size(); ++k) by_fault[fault_name(k) + "_m"] = distances[k];
  const bool is_checked = !is_path_of_odometry(health) && !is_mostly_unmatched();
  const auto scale_metrics = [&](const std::optional<slam::OdometryScale>& scale) {
    return is_checked ? to_metrics(scale) : io::Metrics();
  };
  return {{"segments", health.num_segments},
          {"faulty_segments", health.num_faulty},
          {"faulty_ratio", health.faulty_ratio()},
          {"distance_m", health.distance_m},
          {"faulty_distance", by_fault},
          {"faults", listed},
          {"distance_scale", scale_metrics(health.distance)},
          {"turn_scale", scale_metrics(health.turn)},
          {"steering_rad_per_m", scale_metrics(health.steering)},
          {"delay_s", health.delay_s},
          {"gaps", health.num_gaps},
          {"max_gap_s", health.max_gap_s}};
}

report::VerdictBlock OdometryReport::block() const {
  report::TableBlock table{.caption = "",
                           .columns = {{"odometry"}, {"from, s", true}, {"place in the map, m"}, {"over, m", true}},
                           .rows = {}};
  for (std::size_t i = 0; i < std::min(kShownFaults, health.faulty.size()); ++i) {
    const slam::FaultyOdometry& entry = health.faulty[i];
    table.rows.push_back({{fault_name(entry.fault)},
                          {fmt::format("{:.0f}", seconds(entry.first_scan))},
                          {fmt::format("({:.1f}, {:.1f})", entry.p_map.x(), entry.p_map.y())},
                          {fmt::format("{:.1f}", entry.distance_m)}});
  }
  const MappingVerdict result = verdict();
  return {.word = result.word, .tone = result.tone, .reason = result.reason, .checks = std::move(table)};
}

}  // namespace patrol::app
