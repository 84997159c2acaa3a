#include "app/campaign/sweep/error_sources.h"

#include <utility>

#include <fmt/format.h>

namespace patrol::app {
namespace {

bool has_belts(const Scenario&, const ScenarioFiles& files) { return files.robot.tracks.has_value(); }

template <IsSensorMessage Message>
bool has_sensor(const Scenario& scenario, const ScenarioFiles& files) {
  return sim::is_enabled<Message>(scenario.sensors) && is_fitted<Message>(files.robot);
}

std::vector<Imperfection> imperfections_of_sensors() {
  std::vector<Imperfection> all;
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
      if constexpr (requires(const sim::SensorSuiteSettings& all) { (all.*SensorTraits<Message>::kSettings).latency_s; }) {
        overrides.push_back(fmt::format("sensors.{}.latency_s=0", SensorTraits<Message>::kInfo.name));
      }
    }
  });
  return overrides;
}

std::vector<Imperfection> other_imperfections() {
  return {
      {"belts: slip (friction 2)", {"track_drive.friction=2"}, has_belts},
      {"latency of all sensors", latency_overrides()},
      {"people and vehicles", {"actors=[]"}},
      {"faults", {"faults=[]"}},
      {"put down off the start", {"start.ahead_m=0", "start.left_m=0", "start.turn_deg=0"}},
      {"map: cells of 5 cm (2.5 cm)", {"stack.slam.resolution_m=0.025", "stack.graph.tracking.resolution_m=0.025"}},
  };
}

}  // namespace

const std::vector<Imperfection>& imperfections() {
  static const std::vector<Imperfection> kAll = [] {
    std::vector<Imperfection> all = imperfections_of_sensors();
    for (Imperfection& imperfection : other_imperfections()) all.push_back(std::move(imperfection));
    return all;
  }();
  return kAll;
}

}  // namespace patrol::app
