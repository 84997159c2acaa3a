#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>

#include "core/time.h"

namespace patrol::localize {

/// Readings in order of their stamps, waiting for the IMU of their instant.
template <typename Reading>
class PendingReadings {
 public:
  bool is_empty() const { return readings_.empty(); }
  bool is_full() const { return readings_.size() >= kMaxReadings; }
  const Reading& oldest() const { return readings_.front(); }
  Reading& oldest() { return readings_.front(); }
  const Reading& newest() const { return readings_.back(); }

  void insert(const Reading& reading) {
    const auto later = std::upper_bound(readings_.begin(), readings_.end(), reading.stamp,
                                        [](Time stamp, const Reading& other) { return stamp < other.stamp; });
    readings_.insert(later, reading);
  }
  void pop_oldest() { readings_.pop_front(); }
  void clear() { readings_.clear(); }

  auto begin() { return readings_.begin(); }
  auto end() { return readings_.end(); }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(readings_);
  }

 private:
  static constexpr std::size_t kMaxReadings = 256;

  std::deque<Reading> readings_;
};

}  // namespace patrol::localize
