#include "localize/slip_detector.h"

#include <algorithm>
#include <cmath>

namespace patrol::localize {
namespace {

constexpr double kSigmas = 4.0;         // significance threshold for the roughness
constexpr double kLastingSigmas = 3.0;  // significance threshold for the lasting error of the acceleration
constexpr double kMaxLateness_s = 0.5;  // maximum delay of the tracks behind the IMU

}  // namespace

void SlipDetector::reset() { readings_.clear(); }

// Roughness: consecutive accelerations of a smooth ride are similar. Half their squared difference is the variance of
// the rough part.
void SlipDetector::add_acceleration(Time stamp, double dt_s, double acceleration_mps2, double std_mps2) {
  Sum sum = sums_.empty() ? Sum{} : sums_.back();
  const double rough = acceleration_mps2 - last_acceleration_;
  sum.stamp = stamp;
  sum.speed_mps += acceleration_mps2 * dt_s;
  sum.variance_m2ps2 += 0.5 * rough * rough * dt_s * dt_s;
  sum.lasting_std_mps += std_mps2 * dt_s;
  last_acceleration_ = acceleration_mps2;
  sums_.push_back(sum);
  while (to_seconds(stamp - sums_.front().stamp) > kMaxLateness_s) sums_.pop_front();
}

std::optional<SlipDetector::Sum> SlipDetector::sum_at(Time stamp) const {
  const auto after =
      std::lower_bound(sums_.begin(), sums_.end(), stamp, [](const Sum& sum, Time when) { return sum.stamp < when; });
  if (after == sums_.end() || (after == sums_.begin() && after->stamp > stamp)) return std::nullopt;
  return *after;
}

double SlipDetector::roughness_bound_mps(const Sum& from, const Sum& to) {
  return kSigmas * std::sqrt(to.variance_m2ps2 - from.variance_m2ps2);
}

double SlipDetector::roughness_bound_mps() const {
  return evidence_start_ && !sums_.empty() ? roughness_bound_mps(*evidence_start_, sums_.back()) : 0.0;
}

std::optional<SlipEvidence> SlipDetector::add_speed(Time stamp, double tracks_mps, double estimated_mps) {
  const std::optional<Sum> sum = sum_at(stamp);
  if (!sum) {
    reset();
    return std::nullopt;
  }
  readings_.push_back({*sum, tracks_mps, estimated_mps});
  while (to_seconds(stamp - readings_.front().sum.stamp) > settings_.window_s) readings_.pop_front();
  const Reading& first = readings_.front();
  const double felt = sum->speed_mps - first.sum.speed_mps;
  const double disagreement = (tracks_mps - first.tracks_mps) - felt;
  const double lasting_std = sum->lasting_std_mps - first.sum.lasting_std_mps;
  const double threshold =
      settings_.threshold_mps + roughness_bound_mps(first.sum, *sum) + kLastingSigmas * lasting_std;
  if (std::abs(disagreement) < threshold) return std::nullopt;
  evidence_start_ = first.sum;
  return SlipEvidence{.forward_mps = first.estimated_mps + felt,
                      .disagreement_mps = disagreement,
                      .duration_s = to_seconds(stamp - first.sum.stamp)};
}

}  // namespace patrol::localize
