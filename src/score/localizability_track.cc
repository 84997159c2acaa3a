#include "score/localizability_track.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/principal_axes.h"

namespace patrol::score {
namespace {

constexpr Time kSpacing = std::chrono::milliseconds(500);

/// Confidence of the estimate with the same stamp.
std::optional<double> confidence_at(const std::vector<LocalizationConfidence>& confidences, Time stamp) {
  const auto found = std::ranges::lower_bound(confidences, stamp, {}, &LocalizationConfidence::stamp);
  if (found == confidences.end() || found->stamp != stamp) return std::nullopt;
  return found->confidence;
}

}  // namespace

std::vector<TrackedLocalizability> track_localizability(const RunRecord& record, const Pose2& T_world_map,
                                                        const LocalizabilityOracle& oracle) {
  std::vector<TrackedLocalizability> track;
  if (!oracle) return track;
  for (std::size_t i = 0; i < record.T_map_body.size(); ++i) {
    const Time stamp = record.T_map_body[i].stamp;
    if (!track.empty() && stamp - track.back().stamp < kSpacing) continue;
    const std::optional<Pose3> truth = pose_at(record.T_world_body, stamp);
    if (!truth) continue;
    const Eigen::Vector2d p_world_m = truth->position.head<2>();
    const PrincipalAxes axes = principal_axes(record.covariances[i].topLeftCorner<2, 2>());
    track.push_back({.stamp = stamp,
                     .p_world_m = p_world_m,
                     .sample = {.truth = oracle(p_world_m),
                                .reported_std_m = std::sqrt(std::max(axes.large, 0.0)),
                                .reported_direction_rad = T_world_map.yaw + axes.large_direction_rad,
                                .confidence = confidence_at(record.confidences, stamp)}});
  }
  return track;
}

LocalizabilityScore score_of(const std::vector<TrackedLocalizability>& track) {
  std::vector<LocalizabilitySample> samples;
  for (const TrackedLocalizability& at : track) samples.push_back(at.sample);
  return localizability_score(samples);
}

}  // namespace patrol::score
