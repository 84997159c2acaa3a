#include "localize/motion_history.h"

namespace patrol::localize {

void MotionHistory::push(Time stamp, const TrunkMotion& motion) {
  if (size_ > 0 && stamp == newest()) {
    ring_[(first_ + size_ - 1) % ring_.size()].motion = motion;
    return;
  }
  if (size_ < ring_.size()) {
    ++size_;
  } else {
    first_ = (first_ + 1) % ring_.size();
  }
  ring_[(first_ + size_ - 1) % ring_.size()] = {stamp, motion};
}

std::optional<MotionHistory::Bracket> MotionHistory::find(Time stamp) const {
  if (size_ == 0 || stamp < oldest() || stamp > newest()) return std::nullopt;
  std::size_t low = 0, high = size_ - 1;  // at(low).stamp <= stamp <= at(high).stamp
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (at(middle).stamp <= stamp ? low : high) = middle;
  }
  const Entry &before = at(low), &after = at(high);
  if (stamp >= after.stamp) return Bracket{after, after, 0.0};
  return Bracket{before, after, to_seconds(stamp - before.stamp) / to_seconds(after.stamp - before.stamp)};
}

std::optional<TrunkMotion> MotionHistory::motion_at(Time stamp) const {
  const std::optional<Bracket> bracket = find(stamp);
  if (!bracket) return std::nullopt;
  const TrunkMotion &a = bracket->before.motion, &b = bracket->after.motion;
  if (bracket->fraction == 0.0) return a;
  return TrunkMotion{.T_odom_body = interpolate(a.T_odom_body, b.T_odom_body, bracket->fraction),
                     .v_body = a.v_body + bracket->fraction * (b.v_body - a.v_body),
                     .omega_body = a.omega_body + bracket->fraction * (b.omega_body - a.omega_body)};
}

std::optional<Pose3> MotionHistory::pose_at(Time stamp) const {
  const std::optional<Bracket> bracket = find(stamp);
  if (!bracket) return std::nullopt;
  return interpolate(bracket->before.motion.T_odom_body, bracket->after.motion.T_odom_body, bracket->fraction);
}

}  // namespace patrol::localize
