#include "app/campaign/sweep/fault_matrix.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace patrol::app {
namespace {

constexpr double kDelay_s = 0.3;
constexpr double kJitter_s = 0.1;
constexpr double kClockOffset_s = 0.2;

/// Whether the scenario triggers readings of a sensor.
bool is_triggered(SensorTrigger trigger, const ScenarioFiles& files) {
  const auto is_scanned = [](const SavedGoal& goal) { return goal.type == GoalType::kScan; };
  switch (trigger) {
    case SensorTrigger::kPeriodic:
      return true;
    case SensorTrigger::kScanStation:
      return std::any_of(files.goals.begin(), files.goals.end(), is_scanned);
    case SensorTrigger::kTeleoperation:
      return files.has_teleop();
  }
  return true;
}

template <IsSensorMessage Message>
bool is_in_matrix(const Scenario& scenario, const ScenarioFiles& files) {
  constexpr SensorInfo kInfo = SensorTraits<Message>::kInfo;
  return *kInfo.fault_matrix_exclusion_reason == '\0' && sim::is_enabled<Message>(scenario.sensors) &&
         is_fitted<Message>(files.robot) && is_triggered(kInfo.trigger, files);
}

constexpr std::string_view kBetween = ": ";

}  // namespace

std::vector<sim::FaultSettings> fault_matrix(const Scenario& scenario, const ScenarioFiles& files, double start_s,
                                             double duration_s) {
  std::vector<sim::FaultSettings> faults;
  Sensors::for_each([&]<typename Message>(std::type_identity<Message>) {
    if (!is_in_matrix<Message>(scenario, files)) return;
    constexpr SensorInfo kInfo = SensorTraits<Message>::kInfo;
    const std::array<std::pair<const char*, double>, 7> kinds = {{{"dropout", 1.0},
                                                                  {"freeze", 1.0},
                                                                  {"delay", kDelay_s},
                                                                  {"jitter", kJitter_s},
                                                                  {"clock_offset", kClockOffset_s},
                                                                  {"drift", kInfo.fault.drift_per_s},
                                                                  {"outliers", kInfo.fault.outlier}}};
    for (const auto& [kind, magnitude] : kinds) {
      faults.push_back(
          {.sensor = kInfo.name, .kind = kind, .start_s = start_s, .duration_s = duration_s, .magnitude = magnitude});
    }
  });
  return faults;
}

std::vector<std::string> survival_overrides(const Scenario& scenario, const SurvivalBounds& bounds) {
  std::vector<std::string> overrides;
  const auto expect = [&](const char* metric, const char* limit, double value) {
    if (scenario.expect.contains(metric)) return;
    overrides.push_back(fmt::format("expect.{}={{{}: {}}}", metric, limit, value));
  };
  expect("pose.ate_max_m", "max", bounds.max_error_m);
  expect("map.coverage", "min", bounds.min_map_coverage);
  if (!scenario.map.empty()) expect("localization.lost_s", "max", bounds.max_lost_s);
  return overrides;
}

std::string variant_name(const sim::FaultSettings& fault) {
  return fmt::format("{}{}{}", fault.sensor, kBetween, fault.kind);
}

FaultVariant parse_variant_name(const std::string& variant_name) {
  const std::size_t between = variant_name.find(kBetween);
  if (between == std::string::npos) return {.sensor = variant_name, .kind = ""};
  return {.sensor = variant_name.substr(0, between), .kind = variant_name.substr(between + kBetween.size())};
}

std::string fault_override(const sim::FaultSettings& fault) {
  return fmt::format("faults=[{{sensor: {}, kind: {}, start_s: {}, duration_s: {}, magnitude: {}}}]", fault.sensor,
                     fault.kind, fault.start_s, fault.duration_s, fault.magnitude);
}

}  // namespace patrol::app
