#include "sim/sensors/fault_injector.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>

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

FaultInjector::FaultInjector(const std::vector<FaultSettings>& faults, std::uint64_t seed) {
  for (const FaultSettings& fault : faults) {
    const auto is_alike = [&](const FaultStatus& other) {
      return other.fault.sensor == fault.sensor && other.fault.kind == fault.kind;
    };
    const auto number = std::ranges::count_if(reports_, is_alike);
    reports_.push_back({.fault = fault});
    draws_.emplace_back(seed, fmt::format("fault/{}/{}/{}", fault.sensor, fault.kind, number));
  }
}

bool FaultInjector::apply(Time ready, Time& due, SensorMessage& message) {
  const std::string_view sensor = kSensorInfos[message.index()].name;
  std::optional<SensorMessage>& last_good = last_good_[message.index()];
  const std::uint64_t number = num_messages_[message.index()]++;
  bool is_frozen = false;
  for (std::size_t i = 0; i < reports_.size(); ++i) {
    const FaultSettings& fault = reports_[i].fault;
    if (fault.sensor != sensor || !fault.is_active(ready)) continue;
    if (!change(i, number, ready, due, message)) return false;
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

/// Applies an active fault to message number `number` of its sensor. Returns false when the message is lost.
bool FaultInjector::change(std::size_t index, std::uint64_t number, Time ready, Time& due, SensorMessage& message) {
  FaultStatus& report = reports_[index];
  const FaultSettings& fault = report.fault;
  const RandomStream& draw = draws_[index];
  const std::optional<SensorMessage>& last_good = last_good_[message.index()];
  const bool is_outlier = fault.kind == "outliers" && draw.uniform(number) < kOutlierProbability;
  report.was_triggered |= (fault.kind != "outliers" || is_outlier) && (fault.kind != "freeze" || last_good);
  if (fault.kind == "dropout") return false;
  if (fault.kind == "delay") due += from_seconds(fault.magnitude);
  if (fault.kind == "jitter") due += from_seconds(std::abs(fault.magnitude * draw.normal(number)));
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
