#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <optional>
#include <utility>

#include "core/sensors/recorded_scan.h"

namespace patrol::io {

/// Puts scans in order of time by holding a few back. Those of one stamp keep the order in which they came. A scan with a stamp far
/// ahead of the others does no harm: it is held back until the end.
class ScanSorter {
 public:
  static constexpr std::size_t kWindow = 32;  ///< scans that are held back

  enum class Order { kInOrder, kReordered, kTooLate };

  /// Too late: a later one was already taken; this one is dropped.
  Order add(RecordedScan scan) {
    const Time stamp = scan.scan.stamp;
    if (last_taken_ && stamp < *last_taken_) return Order::kTooLate;
    const auto place = std::upper_bound(held_.begin(), held_.end(), stamp, [](Time t, const RecordedScan& held) { return t < held.scan.stamp; });
    const Order order = place == held_.end() ? Order::kInOrder : Order::kReordered;
    held_.insert(place, std::move(scan));
    return order;
  }

  /// The earliest, once enough are held, or none is to come any more.
  std::optional<RecordedScan> take(bool is_at_end) {
    if (held_.empty() || (!is_at_end && held_.size() <= kWindow)) return std::nullopt;
    std::optional<RecordedScan> first = std::move(held_.front());
    held_.pop_front();
    last_taken_ = first->scan.stamp;
    return first;
  }

  bool is_empty() const { return held_.empty(); }
  /// Of the last one taken.
  std::optional<Time> last_taken() const { return last_taken_; }

 private:
  std::deque<RecordedScan> held_;  ///< by growing stamp
  std::optional<Time> last_taken_;
};

}  // namespace patrol::io
