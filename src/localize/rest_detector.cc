#include "localize/rest_detector.h"

namespace patrol::localize {

void RestDetector::add(Time stamp, const Eigen::Vector3d& force_mps2) {
  const Time begin = stamp - from_seconds(settings_.window_s);
  if (!samples_.empty() && samples_.back().stamp <= begin) samples_.clear();
  samples_.push_back({stamp, force_mps2});
  while (samples_.size() > 1 && samples_[1].stamp <= begin) samples_.pop_front();
}

bool RestDetector::is_at_rest() const {
  if (samples_.empty() || to_seconds(samples_.back().stamp - samples_.front().stamp) < settings_.window_s) return false;
  const auto count = static_cast<double>(samples_.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero(), variance = Eigen::Vector3d::Zero();
  for (const Sample& sample : samples_) mean += sample.force_mps2 / count;
  for (const Sample& sample : samples_) variance += (sample.force_mps2 - mean).cwiseAbs2() / count;
  return variance.maxCoeff() <= settings_.max_std_mps2 * settings_.max_std_mps2;
}

}  // namespace patrol::localize
