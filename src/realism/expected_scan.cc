#include "realism/expected_scan.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/geometry/angles.h"

namespace patrol::realism {
namespace {

constexpr double kMinJump_m = 0.1, kMaxJump_m = 1.5;  // of mixed pixels in the lidar model (sim/sensors/lidar.cc)
constexpr double kMaxWide_rad = 15.0 * kDegree;       // of the margin in meters, on near surfaces

/// Casts about one beam.
class BeamFan {
 public:
  BeamFan(const Site& site, const PosedScan& posed, std::size_t beam)
      : site_(site),
        posed_(posed),
        T_site_lidar_(posed.pose_of(beam)),
        azimuth_rad_(posed.azimuth_rad(beam)),
        max_range_m_(posed.scan.range_max_m) {}

  std::optional<SurfaceHit> cast(double offset_rad) const {
    return site_.cast(T_site_lidar_.position, direction(offset_rad), max_range_m_);
  }
  Eigen::Vector3d direction(double offset_rad) const {
    return T_site_lidar_.rotation * posed_.direction_at(azimuth_rad_ + offset_rad);
  }

 private:
  const Site& site_;
  const PosedScan& posed_;
  Pose3 T_site_lidar_;
  double azimuth_rad_, max_range_m_;
};

/// Returns whether ranges at equal steps to both sides continue the surface. On a plane the second difference is r (1 +
/// 2 tan^2) step^2 for small steps.
bool is_continuous(double range_m, double low_m, double high_m, double slope_m_per_rad, double step_rad,
                   const BeamRules& rules) {
  const double tangent = slope_m_per_rad / range_m;
  const double curvature_m = range_m * (1.0 + 2.0 * tangent * tangent) * step_rad * step_rad;
  return std::abs(low_m + high_m - 2.0 * range_m) < rules.jump_m + 2.0 * curvature_m;
}

/// Returns whether two hits are on surfaces of the same direction and the same optical properties.
bool is_same_surface(const SurfaceHit& hit, const SurfaceHit& other, const BeamRules& rules) {
  return hit.normal.dot(other.normal) >= std::cos(rules.max_turn_deg * kDegree) - 1e-9 &&
         std::abs(hit.reflectivity - other.reflectivity) < 1e-3 && hit.is_glass == other.is_glass;
}

/// Whether the surface of a beam continues: to the neighboring beams, and over the distance of the rules.
struct Continuity {
  bool is_local = false, is_wide = false;
};

Continuity continuity_of(const BeamFan& fan, const SurfaceHit& hit, double slope_m_per_rad, double step_rad,
                         const BeamRules& rules) {
  const auto is_continued = [&](double offset_rad) {
    const std::optional<SurfaceHit> low = fan.cast(-offset_rad), high = fan.cast(offset_rad);
    return low && high && is_same_surface(hit, *low, rules) && is_same_surface(hit, *high, rules) &&
           is_continuous(hit.range_m, low->range_m, high->range_m, slope_m_per_rad, offset_rad, rules);
  };
  const double margin_rad = rules.margin_deg * kDegree;
  Continuity result{.is_local = true};
  for (const double offset_rad : {0.25 * margin_rad, 0.5 * margin_rad, margin_rad, std::max(margin_rad, step_rad)}) {
    if (!is_continued(offset_rad)) return {};
  }
  result.is_wide = true;
  const double wide_rad = std::min(std::atan2(rules.margin_m, hit.range_m), kMaxWide_rad);
  for (const double offset_rad : {0.5 * wide_rad, wide_rad}) {
    if (offset_rad > margin_rad && !is_continued(offset_rad)) result.is_wide = false;
  }
  return result;
}

/// Beam with the continuity of its surface to the neighboring beams.
std::pair<ExpectedBeam, bool> expected_beam(const BeamFan& fan, double step_rad, const BeamRules& rules) {
  ExpectedBeam beam;
  const std::optional<SurfaceHit> hit = fan.cast(0.0);
  if (!hit) return {beam, false};
  beam.range_m = hit->range_m;
  beam.normal = hit->normal;
  beam.cosine = std::min(1.0, -hit->normal.dot(fan.direction(0.0)));
  beam.reflectivity = hit->reflectivity;
  beam.is_glass = hit->is_glass;
  const double offset_rad = 0.25 * rules.margin_deg * kDegree;
  const std::optional<SurfaceHit> low = fan.cast(-offset_rad), high = fan.cast(offset_rad);
  if (low && high) beam.slope_m_per_rad = (high->range_m - low->range_m) / (2.0 * offset_rad);
  const Continuity continuity = continuity_of(fan, *hit, beam.slope_m_per_rad, step_rad, rules);
  beam.is_smooth = continuity.is_wide;
  return {beam, continuity.is_local};
}

}  // namespace

std::vector<ExpectedBeam> expected_beams(const Site& site, const PosedScan& posed, const BeamRules& rules) {
  std::vector<ExpectedBeam> beams;
  beams.reserve(posed.num_beams());
  const double step_rad = std::abs(posed.scan.angle_increment_rad);
  for (std::size_t i = 0; i < posed.num_beams(); ++i) {
    const auto [beam, is_continued] = expected_beam(BeamFan(site, posed, i), step_rad, rules);
    beams.push_back(beam);
    if (i == 0) continue;
    const double jump_m = std::abs(beams[i].range_m - beams[i - 1].range_m);
    beams[i].is_jump = !is_continued && jump_m > kMinJump_m && jump_m < kMaxJump_m;
  }
  return beams;
}

std::vector<Beam> beams_of(const PosedScan& posed, const std::vector<ExpectedBeam>& expected,
                           const std::vector<float>& ranges_m, std::uint32_t scan, const BeamRules& rules) {
  std::vector<Beam> beams;
  beams.reserve(expected.size());
  for (std::size_t i = 0; i < expected.size() && i < ranges_m.size(); ++i) {
    Beam beam{.expected = expected[i],
              .recorded_m = static_cast<double>(ranges_m[i]),
              .scan = scan,
              .index = static_cast<std::uint32_t>(i)};
    if (expected[i].has_surface()) {
      const Pose3 T_site_lidar = posed.pose_of(i);
      const Eigen::Vector3d point =
          T_site_lidar * Eigen::Vector3d(expected[i].range_m * posed.direction_at(posed.azimuth_rad(i)));
      beam.x_m = static_cast<float>(point.x()), beam.y_m = static_cast<float>(point.y());
    }
    beams.push_back(beam);
  }
  classify(rules, beams);
  return beams;
}

}  // namespace patrol::realism
