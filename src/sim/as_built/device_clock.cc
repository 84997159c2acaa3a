#include "sim/as_built/device_clock.h"

#include <algorithm>
#include <cmath>

namespace patrol::sim {

Time DeviceClock::stamp(Time instant) const {
  if (offset_s_ == 0.0 && drift_ == 0.0) return instant;
  return std::max(Time{}, instant + from_seconds(offset_s_ + drift_ * to_seconds(instant)));
}

Time DeviceClock::transport_delay(std::uint64_t index) const {
  return mean_jitter_s_ > 0.0 ? from_seconds(-mean_jitter_s_ * std::log(jitter_.uniform(index))) : Time{};
}

}  // namespace patrol::sim
