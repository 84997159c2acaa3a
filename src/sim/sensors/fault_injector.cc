#include "sim/sensors/fault_injector.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace patrol::sim {
namespace {

constexpr double kOutlierProbability = 0.1;  // probability per message while the fault lasts

void add_to_reading(SensorMessage& message, double offset) {
  const auto add = [&]<typename Message>(Message& content) { SensorTraits<Message>::add_to_reading(content, offset); };
  std::visit(add, message);
}

void set_stamp(SensorMessage& message, Time stamp) {
  std::visit([&](auto& content) { content.stamp = stamp; }, message);
}

}  // namespace

FaultInjector::FaultInjector(const std::vector<FaultSettings>& faults, std::uint64_t seed)
    : outliers_(seed, "fault/spikes"), jitter_(seed, "fault/jitter") {
  for (const FaultSettings& fault : faults) reports_.push_back({.fault = fault});
}

bool FaultInjector::apply(Time ready, Time& due, SensorMessage& message) {
  const std::string_view sensor = kSensorInfos[message.index()].name;
  std::optional<SensorMessage>& last_good = last_good_[message.index()];
  bool is_frozen = false;
  for (FaultStatus& report : reports_) {
    const FaultSettings& fault = report.fault;
    if (fault.sensor != sensor || !fault.is_active(ready)) continue;
    if (!change(report, ready, due, message)) return false;
    if (fault.kind == "freeze" && last_good) is_frozen = true;
  }
  if (!is_frozen && (!std::holds_alternative<PanoramicScan>(message) || has_fault(sensor))) last_good = message;
  return true;
}

bool FaultInjector::has_fault(std::string_view sensor) const {
  return std::ranges::any_of(reports_, [&](const FaultStatus& report) { return report.fault.sensor == sensor; });
}

void FaultInjector::set_triggered(const FaultStatus& status) {
  const auto key = [](const FaultSettings& fault) {
    return std::tie(fault.sensor, fault.kind, fault.start_s, fault.duration_s, fault.magnitude);
  };
  for (FaultStatus& report : reports_) {
    if (key(report.fault) == key(status.fault)) report.was_triggered = status.was_triggered;
  }
}

/// Applies one active fault. Returns false when the message is lost.
bool FaultInjector::change(FaultStatus& report, Time ready, Time& due, SensorMessage& message) {
  const FaultSettings& fault = report.fault;
  const std::optional<SensorMessage>& last_good = last_good_[message.index()];
  const bool is_outlier = fault.kind == "outliers" && outliers_.uniform(outlier_count_++) < kOutlierProbability;
  report.was_triggered |= (fault.kind != "outliers" || is_outlier) && (fault.kind != "freeze" || last_good);
  if (fault.kind == "dropout") return false;
  if (fault.kind == "delay") due += from_seconds(fault.magnitude);
  if (fault.kind == "jitter") due += from_seconds(std::abs(fault.magnitude * jitter_.normal(jitter_count_++)));
  if (fault.kind == "clock_offset") set_stamp(message, stamp_of(message) + from_seconds(fault.magnitude));
  if (fault.kind == "drift") add_to_reading(message, fault.magnitude * (to_seconds(ready) - fault.start_s));
  if (is_outlier) add_to_reading(message, fault.magnitude);
  if (fault.kind == "freeze" && last_good) {
    const Time stamp = stamp_of(message);
    message = *last_good;
    set_stamp(message, stamp);
  }
  return true;
}

}  // namespace patrol::sim
