#pragma once

#include <deque>

#include <Eigen/Core>

#include "core/time.h"

namespace patrol::localize {

/// Detector of a body at rest by its accelerometer: a body on tracks that drives or slides is shaken.
class RestDetector {
 public:
  struct Settings {
    double window_s;
    double max_std_mps2;  ///< standard deviation of each axis over the window, up to which the body is at rest
  };
  explicit RestDetector(const Settings& settings) : settings_(settings) {}

  /// Adds a reading of the accelerometer, in its own frame, m/s2. Stamps increase; a gap of the length of the window
  /// starts a new window.
  void add(Time stamp, const Eigen::Vector3d& force_mps2);
  /// Returns whether the body has been at rest over the whole window; false before the window is full.
  bool is_at_rest() const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(samples_);
  }

 private:
  struct Sample {
    Time stamp{};
    Eigen::Vector3d force_mps2;
  };

  Settings settings_;
  std::deque<Sample> samples_;  ///< samples of the window, and one before it
};

}  // namespace patrol::localize
