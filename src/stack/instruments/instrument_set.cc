#include "stack/instruments/instrument_set.h"

#include <algorithm>
#include <utility>

namespace patrol::stack {

InstrumentSet::InstrumentSet(std::vector<std::unique_ptr<Instrument>> instruments, double siren_duration_s)
    : instruments_(std::move(instruments)), light_(siren_duration_s) {}

void InstrumentSet::add(const SensorMessage& message, const StationPoseLookup& station_pose_at) {
  for (const auto& instrument : instruments_) instrument->add(message, station_pose_at);
}

InspectionProgress InstrumentSet::step(Time now, const std::optional<InspectionOrder>& order,
                                       const StationPose& station_pose, StackOutput& output) {
  light_.step(now, output);
  if (order != order_) {
    if (Instrument* before = order_ ? find(order_->instrument) : nullptr) before->end();
    order_ = order;
    if (Instrument* next = order ? find(order->instrument) : nullptr) next->begin(*order, now);
  }
  if (!order) return {};
  Instrument* instrument = find(order->instrument);
  if (!instrument) return {.feedback = InspectionFeedback::kFailed};
  return instrument->step({.now = now, .station_pose = station_pose, .output = output, .light = light_});
}

Instrument* InstrumentSet::find(InstrumentKind kind) const {
  const auto found = std::find_if(instruments_.begin(), instruments_.end(),
                                  [&](const auto& instrument) { return instrument->kind() == kind; });
  return found == instruments_.end() ? nullptr : found->get();
}

}  // namespace patrol::stack
