#pragma once

#include <Eigen/Core>

namespace patrol::localize {

/// Detects a sensor whose readings no longer change: noise never repeats a reading many times in a row while the robot
/// moves.
template <int kSize>
class FrozenReadings {
 public:
  /// Whether this reading and the ones before it are the same.
  bool is_frozen(const Eigen::Matrix<double, kSize, 1>& reading) {
    count_ = reading == last_ ? count_ + 1 : 0;
    last_ = reading;
    return count_ >= kMaxRepeats;
  }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(last_, count_);
  }

 private:
  static constexpr int kMaxRepeats = 10;

  Eigen::Matrix<double, kSize, 1> last_ = Eigen::Matrix<double, kSize, 1>::Zero();
  int count_ = 0;
};

}  // namespace patrol::localize
