#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/time.h"
#include "localize/inertial_motion.h"

namespace patrol::localize {

/// Ring buffer of the recent trunk motion, for beams and measurements with past stamps.
class MotionHistory {
 public:
  explicit MotionHistory(std::size_t capacity) : ring_(capacity) {}

  /// Adds a motion. Stamps must increase; an equal stamp replaces the newest entry.
  void push(Time stamp, const TrunkMotion& motion);

  void clear() { size_ = 0; }

  bool empty() const { return size_ == 0; }
  Time oldest() const { return at(0).stamp; }
  Time newest() const { return at(size_ - 1).stamp; }
  const TrunkMotion& newest_motion() const { return at(size_ - 1).motion; }

  /// Returns the interpolated motion; nullopt outside the buffer.
  std::optional<TrunkMotion> motion_at(Time stamp) const;
  std::optional<Pose3> pose_at(Time stamp) const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(ring_, first_, size_);
  }

 private:
  struct Entry {
    Time stamp{};
    TrunkMotion motion;
  };
  /// Entries around a stamp, and the interpolation fraction from the first to the second.
  struct Bracket {
    const Entry& before;
    const Entry& after;
    double fraction;
  };
  std::optional<Bracket> find(Time stamp) const;
  const Entry& at(std::size_t age_order) const { return ring_[(first_ + age_order) % ring_.size()]; }

  std::vector<Entry> ring_;
  std::size_t first_ = 0;
  std::size_t size_ = 0;
};

}  // namespace patrol::localize
