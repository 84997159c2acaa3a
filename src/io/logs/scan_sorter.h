#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <optional>
#include <utility>

#include "core/sensors/recorded_scan.h"

namespace patrol::io {

/// Sorts scans by stamp within a window of `kWindow` scans. Scans with equal stamps keep their order. A scan whose
/// stamp is far ahead of the others does not affect them: it is kept until the end.
class ScanSorter {
 public:
  static constexpr std::size_t kWindow = 32;  ///< number of scans kept for sorting

  enum class Order { kInOrder, kReordered, kTooLate };

  /// Adds a scan. kTooLate: a later scan was already taken, and this one is dropped.
  Order add(RecordedScan scan) {
    const Time stamp = scan.scan.stamp;
    if (last_taken_ && stamp < *last_taken_) return Order::kTooLate;
    const auto position = std::upper_bound(pending_.begin(), pending_.end(), stamp,
                                           [](Time t, const RecordedScan& pending) { return t < pending.scan.stamp; });
    const Order order = position == pending_.end() ? Order::kInOrder : Order::kReordered;
    pending_.insert(position, std::move(scan));
    return order;
  }

  /// Returns the earliest scan if the window is full or the log is at its end.
  std::optional<RecordedScan> take(bool is_at_end) {
    if (pending_.empty() || (!is_at_end && pending_.size() <= kWindow)) return std::nullopt;
    std::optional<RecordedScan> first = std::move(pending_.front());
    pending_.pop_front();
    last_taken_ = first->scan.stamp;
    return first;
  }

  bool is_empty() const { return pending_.empty(); }
  /// Returns the stamp of the last scan taken.
  std::optional<Time> last_taken() const { return last_taken_; }

 private:
  std::deque<RecordedScan> pending_;  ///< scans not yet taken, by increasing stamp
  std::optional<Time> last_taken_;
};

}  // namespace patrol::io
