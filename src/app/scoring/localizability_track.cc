#include "app/scoring/localizability_track.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angles.h"
#include "core/symmetric_axes.h"
#include "io/csv.h"

namespace patrol::app {
namespace {

constexpr Time kSpacing = std::chrono::milliseconds(500);

/// Trust is said of the estimate with the same stamp.
std::optional<double> trust_at(const std::vector<LocalizationTrust>& trusts, Time stamp) {
  const auto said = std::lower_bound(trusts.begin(), trusts.end(), stamp, [](const LocalizationTrust& one, Time at) { return one.stamp < at; });
  if (said == trusts.end() || said->stamp != stamp) return std::nullopt;
  return said->trust;
}

}  // namespace

std::vector<TrackedLocalizability> track_localizability(const RunRecord& record, const Pose2& T_world_map, const LocalizabilityOracle& oracle) {
  std::vector<TrackedLocalizability> track;
  for (std::size_t i = 0; i < record.T_map_body.size(); ++i) {
    const Time stamp = record.T_map_body[i].stamp;
    if (!track.empty() && stamp - track.back().stamp < kSpacing) continue;
    const std::optional<Pose3> truth = pose_at(record.T_world_body, stamp);
    if (!truth) continue;
    const Eigen::Vector2d p_world_m = truth->position.head<2>();
    const SymmetricAxes own = symmetric_axes(record.covariances[i].topLeftCorner<2, 2>());
    track.push_back({.stamp = stamp,
                     .p_world_m = p_world_m,
                     .sample = {.truth = oracle.at(p_world_m),
                                .claimed_std_m = std::sqrt(std::max(own.large, 0.0)),
                                .claimed_direction_rad = T_world_map.yaw + own.large_direction_rad,
                                .trust = trust_at(record.trusts, stamp)}});
  }
  return track;
}

score::LocalizabilityScore score_of(const std::vector<TrackedLocalizability>& track) {
  std::vector<score::LocalizabilitySample> samples;
  for (const TrackedLocalizability& at : track) samples.push_back(at.sample);
  return score::localizability_score(samples);
}

void save_localizability(const std::filesystem::path& file_csv, const std::vector<TrackedLocalizability>& track) {
  io::Table table{.name = "localizability",
                  .columns = {"time_s", "x_m", "y_m", "weak_std_m", "weak_direction_deg", "strong_std_m", "claimed_std_m", "claimed_direction_deg", "trust"},
                  .rows = {}};
  for (const TrackedLocalizability& at : track) {
    const score::LocalizabilitySample& sample = at.sample;
    const double claimed_deg = kDegPerRad * std::remainder(sample.claimed_direction_rad, std::numbers::pi);
    table.rows.push_back({to_seconds(at.stamp), at.p_world_m.x(), at.p_world_m.y(), sample.truth.weak_std_m, kDegPerRad * sample.truth.weak_direction_rad,
                          sample.truth.strong_std_m, sample.claimed_std_m, claimed_deg, sample.trust ? io::TableValue{*sample.trust} : io::TableValue{}});
  }
  io::save_csv(file_csv, table);
}

}  // namespace patrol::app
