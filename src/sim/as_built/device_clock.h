#pragma once

#include <cstdint>
#include <string>

#include "core/random.h"
#include "core/time.h"

namespace patrol::sim {

/// Clock of a device with constant offset and rate error, and the random delay of its messages on their way.
class DeviceClock {
 public:
  /// Perfect clock.
  DeviceClock() : jitter_(0, "") {}
  /// `mean_jitter_s`: mean of the exponential delay of a message.
  DeviceClock(double offset_s, double drift, double mean_jitter_s, std::uint64_t seed, const std::string& device)
      : offset_s_(offset_s),
        drift_(drift),
        mean_jitter_s_(mean_jitter_s),
        jitter_(seed, "as_built/clock/" + device + "/jitter") {}

  /// Returns the stamp that the device writes at an instant. Never negative.
  Time stamp(Time instant) const;
  /// Returns the delay of message number `index` in addition to its latency.
  Time transport_delay(std::uint64_t index) const;

  double offset_s() const { return offset_s_; }
  double drift() const { return drift_; }

 private:
  double offset_s_ = 0.0;
  double drift_ = 0.0;  ///< relative rate error
  double mean_jitter_s_ = 0.0;
  RandomStream jitter_;
};

}  // namespace patrol::sim
