#include "app/campaign/sweep/error_sources.h"

#include <utility>

#include <fmt/format.h>

namespace patrol::app {
namespace {

bool has_tracks(const Scenario&, const ScenarioFiles& files) { return files.robot.tracks.has_value(); }

template <IsSensorMessage Message>
bool has_sensor(const Scenario& scenario, const ScenarioFiles& files) {
  return sim::is_enabled<Message>(scenario.sensors) && is_fitted<Message>(files.robot);
}

std::vector<ScenarioErrorSource> sensor_error_sources() {
  std::vector<ScenarioErrorSource> all;
  Sensors::for_each([&]<typename Message>(std::type_identity<Message>) {
    for (ErrorSource& source : error_sources<Message>()) {
      all.push_back({std::move(source.name), std::move(source.overrides), has_sensor<Message>});
    }
  });
  return all;
}

/// Overrides that remove the latency of every registered sensor that has one.
std::vector<std::string> latency_overrides() {
  std::vector<std::string> overrides;
  Sensors::for_each([&]<typename Message>(std::type_identity<Message>) {
    if constexpr (HasSensorSettings<Message>) {
      if constexpr (requires(const sim::SensorSuiteSettings& all) {
                      (all.*SensorTraits<Message>::kSettings).latency_s;
                    }) {
        overrides.push_back(fmt::format("sensors.{}.latency_s=0", SensorTraits<Message>::kInfo.name));
      }
    }
  });
  return overrides;
}

std::vector<ScenarioErrorSource> other_error_sources() {
  return {
      {"tracks: slip (friction 2)", {"track_drive.friction=2"}, has_tracks},
      {"latency of all sensors", latency_overrides()},
      {"people and vehicles", {"actors=[]"}},
      {"faults", {"faults=[]"}},
      {"start pose error", {"start.ahead_m=0", "start.left_m=0", "start.yaw_deg=0"}},
      {"map resolution 5 cm (2.5 cm)",
       {"stack.slam.rbpf.resolution_m=0.025", "stack.slam.graph.scan_odometry.resolution_m=0.025"}},
  };
}

}  // namespace

const std::vector<ScenarioErrorSource>& scenario_error_sources() {
  static const std::vector<ScenarioErrorSource> kAll = [] {
    std::vector<ScenarioErrorSource> all = sensor_error_sources();
    for (ScenarioErrorSource& source : other_error_sources()) all.push_back(std::move(source));
    return all;
  }();
  return kAll;
}

}  // namespace patrol::app
