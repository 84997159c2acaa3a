#include "app/campaign/sweep/error_sources.h"

#include <string_view>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

namespace patrol::app {
namespace {

bool has_tracks(const Scenario&, const ScenarioFiles& files) { return files.robot.tracks.has_value(); }
bool has_wheels(const Scenario&, const ScenarioFiles& files) { return !files.robot.wheels.empty(); }

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

bool is_as_built(const Scenario& scenario, const ScenarioFiles&) { return scenario.as_built.enabled; }

template <IsSensorMessage Message>
bool is_as_built_with(const Scenario& scenario, const ScenarioFiles& files) {
  return is_as_built(scenario, files) && has_sensor<Message>(scenario, files);
}

bool is_as_built_with_legs(const Scenario& scenario, const ScenarioFiles& files) {
  return is_as_built_with<JointState>(scenario, files) && !files.robot.legs.empty();
}

bool is_as_built_with_wheels(const Scenario& scenario, const ScenarioFiles& files) {
  return is_as_built(scenario, files) && has_wheels(scenario, files);
}

/// Collects the tolerances of section `as_built`, each as one error source that 0 removes.
class ToleranceCollector {
 public:
  template <typename Value>
  void operator()(const char* group, const Value& tolerances, const Limits& = {}) {
    if constexpr (requires { Value::fields(tolerances, *this); }) {
      group_ = group;
      Value::fields(tolerances, *this);
    } else if constexpr (std::is_same_v<Value, double>) {
      add(group);
    }
  }
  std::vector<ScenarioErrorSource> take() { return std::move(sources_); }

 private:
  using Applies = bool (*)(const Scenario&, const ScenarioFiles&);

  void add(std::string_view field) {
    // None is an error source: ratios of noise, time constants and wavelengths.
    if (field.ends_with("_ratio") || field == "warming_time_s" || field == "cyclic_wavelength_m") return;
    sources_.push_back(
        {fmt::format("as built: {}.{}", group_, field), {fmt::format("as_built.{}.{}=0", group_, field)}, condition()});
  }

  /// Groups of sensors that a robot may lack.
  Applies condition() const {
    if (group_ == "lidar") return is_as_built_with<LaserScan>;
    if (group_ == "joint_encoders" || group_ == "legs") return is_as_built_with_legs;
    if (group_ == "wheels") return is_as_built_with_wheels;
    if (group_ == "tracks") return is_as_built_with<TrackTicks>;
    if (group_ == "imu") return is_as_built_with<Imu>;
    if (group_ == "uwb") return is_as_built_with<UwbRange>;
    if (group_ == "depth_camera") return is_as_built_with<DepthImage>;
    if (group_ == "scanner") return is_as_built_with<PanoramicScan>;
    return is_as_built;
  }

  std::string group_;
  std::vector<ScenarioErrorSource> sources_;
};

std::vector<ScenarioErrorSource> as_built_error_sources() {
  ToleranceCollector collector;
  const sim::AsBuiltSettings settings;
  sim::AsBuiltSettings::fields(settings, collector);
  return collector.take();
}

std::vector<ScenarioErrorSource> other_error_sources() {
  return {
      {"tracks: slip (friction 2)", {"track_drive.friction=2"}, has_tracks},
      {"wheels: slip (friction 2)", {"wheel_drive.friction=2"}, has_wheels},
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
    for (ScenarioErrorSource& source : as_built_error_sources()) all.push_back(std::move(source));
    for (ScenarioErrorSource& source : other_error_sources()) all.push_back(std::move(source));
    return all;
  }();
  return kAll;
}

}  // namespace patrol::app
