#pragma once

#include "core/sensors/registry.h"
#include "sim/dust.h"

namespace patrol::sim {

template <typename List>
struct RegisteredSettings;

/// Settings of all sensors of the registry, each as the member declared in its SensorTraits::Settings.
template <typename... Messages>
struct RegisteredSettings<SensorList<Messages...>> : SensorTraits<Messages>::Settings... {};

/// Settings of section `sensors` of a scenario.
struct SensorSuiteSettings : RegisteredSettings<Sensors> {
  DustSettings dust;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    Sensors::for_each([&]<typename Message>(std::type_identity<Message>) {
      if constexpr (HasSensorSettings<Message>) {
        visit(SensorTraits<Message>::kInfo.name, self.*SensorTraits<Message>::kSettings);
      }
    });
    visit("dust", self.dust);
  }
};

/// Returns whether the settings enable the sensor; true for sensors without such a setting.
template <IsSensorMessage Message>
bool is_enabled(const SensorSuiteSettings& settings) {
  if constexpr (HasSensorSettings<Message>) {
    const auto& own = settings.*SensorTraits<Message>::kSettings;
    if constexpr (requires { own.enabled; }) return own.enabled;
  }
  return true;
}

/// Returns the delay from a reading to its message; 0 for sensors without that setting.
template <IsSensorMessage Message>
double latency_s(const SensorSuiteSettings& settings) {
  if constexpr (HasSensorSettings<Message>) {
    const auto& own = settings.*SensorTraits<Message>::kSettings;
    if constexpr (requires { own.latency_s; }) return own.latency_s;
  }
  return 0.0;
}

}  // namespace patrol::sim
