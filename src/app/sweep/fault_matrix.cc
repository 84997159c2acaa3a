#include "app/sweep/fault_matrix.h"

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

/// A sensor, and how large a fault of its main reading is: well beyond its noise, and what a damaged one might do.
struct FaultySensor {
  std::string_view name;
  bool (*is_there)(const Scenario&, const ScenarioFiles&);
  double drift;   ///< units of the reading per s
  double spikes;  ///< units of the reading
};

/// It is asked for a scan where one of the goals is a station of it.
bool scans(const Scenario& scenario, const ScenarioFiles& files) {
  const auto is_scanned = [](const MarkedGoal& goal) { return goal.type == GoalType::kScan; };
  return scenario.sensors.scanner.enabled && std::any_of(files.goals.begin(), files.goals.end(), is_scanned);
}

constexpr std::array<FaultySensor, 13> kSensors = {{
    {"lidar", [](const Scenario& s, const ScenarioFiles&) { return s.sensors.lidar.enabled; }, 0.02, 1.0},                    // m
    {"lidar3d", [](const Scenario& s, const ScenarioFiles&) { return s.sensors.lidar3d.enabled; }, 0.02, 1.0},                // m
    {"imu", [](const Scenario& s, const ScenarioFiles&) { return s.sensors.imu.enabled; }, 0.005, 1.0},                       // rad/s, yaw rate
    {"joint_encoders", [](const Scenario& s, const ScenarioFiles&) { return s.sensors.joint_encoders.enabled; }, 0.01, 0.3},  // rad, first joint
    {"foot_contact", [](const Scenario& s, const ScenarioFiles&) { return s.sensors.foot_contact.enabled; }, 10.0, 100.0},    // N, first foot
    {"tdlas", [](const Scenario& s, const ScenarioFiles&) { return s.sensors.tdlas.enabled; }, 20.0, 300.0},                  // ppm m
    {"gnss", [](const Scenario& s, const ScenarioFiles&) { return s.sensors.gnss.enabled; }, 0.2, 5.0},                       // m, altitude
    {"hall", [](const Scenario& s, const ScenarioFiles& f) { return s.sensors.hall.enabled && f.robot.tracks.has_value(); }, 50.0, 500.0},  // counts
    {"uwb", [](const Scenario& s, const ScenarioFiles&) { return s.sensors.uwb.enabled; }, 0.05, 3.0},                        // m
    {"ultrasonic", [](const Scenario& s, const ScenarioFiles&) { return s.sensors.ultrasonic.enabled; }, 0.02, 0.5},          // m
    {"depth_camera", [](const Scenario& s, const ScenarioFiles&) { return s.sensors.depth_camera.enabled; }, 0.02, 0.5},      // m
    {"scanner", scans, 0.001, 0.05},                                                                                         // m
    {"remote", [](const Scenario&, const ScenarioFiles& f) { return f.has_remote(); }, 0.02, 0.3},                            // m/s
}};

constexpr std::string_view kBetween = ": ";

}  // namespace

std::vector<sim::FaultSettings> fault_matrix(const Scenario& scenario, const ScenarioFiles& files, double start_s, double duration_s) {
  std::vector<sim::FaultSettings> faults;
  for (const FaultySensor& sensor : kSensors) {
    if (!sensor.is_there(scenario, files)) continue;
    const std::array<std::pair<const char*, double>, 7> kinds = {{{"silence", 1.0}, {"freeze", 1.0}, {"delay", kDelay_s}, {"jitter", kJitter_s},
                                                                   {"clock_offset", kClockOffset_s}, {"drift", sensor.drift}, {"spikes", sensor.spikes}}};
    for (const auto& [kind, magnitude] : kinds) {
      faults.push_back({.sensor = std::string(sensor.name), .kind = kind, .start_s = start_s, .duration_s = duration_s, .magnitude = magnitude});
    }
  }
  return faults;
}

std::string variant_name(const sim::FaultSettings& fault) { return fmt::format("{}{}{}", fault.sensor, kBetween, fault.kind); }

FaultVariant fault_of(const std::string& variant_name) {
  const std::size_t between = variant_name.find(kBetween);
  if (between == std::string::npos) return {.sensor = variant_name, .kind = ""};
  return {.sensor = variant_name.substr(0, between), .kind = variant_name.substr(between + kBetween.size())};
}

std::string fault_override(const sim::FaultSettings& fault) {
  return fmt::format("faults=[{{sensor: {}, kind: {}, start_s: {}, duration_s: {}, magnitude: {}}}]", fault.sensor, fault.kind, fault.start_s,
                     fault.duration_s, fault.magnitude);
}

}  // namespace patrol::app
