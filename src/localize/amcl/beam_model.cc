#include "localize/amcl/beam_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "localize/amcl/distance_to_occupied.h"

namespace patrol::localize {
namespace {

constexpr double kFieldCap_m = 1.0;  // maximum step along a ray

struct PolarBeam {
  double angle_rad, range_m;  ///< from the lidar; +Inf: no return
};

/// Selects at most `max_beams` beams, spread uniformly over the scan. A beam without a hit is used only if it is free
/// up to the maximum range: a shorter one may end where it leaves the height band, and determines no range.
std::vector<PolarBeam> polar_beams(const LevelScan& scan, const BeamModelSettings& settings) {
  std::vector<Eigen::Vector2d> rays;
  std::vector<bool> is_hit;
  for (const LevelScan::Beam& beam : scan.beams) {
    const Eigen::Vector2d ray = beam.end_m.cast<double>() - scan.origin_m;
    if (!ray.allFinite() || (!beam.is_hit && ray.norm() < settings.max_range_m)) continue;
    rays.push_back(ray);
    is_hit.push_back(beam.is_hit);
  }
  std::vector<PolarBeam> beams;
  const std::size_t count = std::min(rays.size(), static_cast<std::size_t>(settings.max_beams));
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = i * rays.size() / count;
    const Eigen::Vector2d& ray = rays[from];
    beams.push_back(
        {std::atan2(ray.y(), ray.x()), is_hit[from] ? ray.norm() : std::numeric_limits<double>::infinity()});
  }
  return beams;
}

double normal_cdf(double ratio) { return 0.5 * std::erfc(-ratio / std::numbers::sqrt2); }

}  // namespace

double beam_log_likelihood(double range_m, double expected_m, const BeamModelSettings& settings) {
  const double sum = settings.z_hit + settings.z_short + settings.z_max + settings.z_rand;
  const double max_m = settings.max_range_m;
  if (!(range_m < max_m)) {
    // An expected range beyond the maximum explains a missing return.
    const double out_of_reach = expected_m < max_m ? 0.0 : settings.z_hit;
    return std::log((settings.z_max + out_of_reach + settings.z_rand / max_m) / sum);
  }
  const double sigma = settings.hit_std_m, ratio = (range_m - expected_m) / sigma;
  const double in_range = normal_cdf((max_m - expected_m) / sigma) - normal_cdf(-expected_m / sigma);
  const double hit = std::exp(-0.5 * ratio * ratio) / (sigma * std::sqrt(2.0 * std::numbers::pi) * in_range);
  const double lambda = 1.0 / settings.short_mean_m;
  const double in_front = range_m <= expected_m && expected_m > 0.0
                              ? lambda * std::exp(-lambda * range_m) / -std::expm1(-lambda * expected_m)
                              : 0.0;
  return std::log((settings.z_hit * hit + settings.z_short * in_front + settings.z_rand / max_m) / sum);
}

BeamModel::BeamModel(const BeamModelSettings& settings, const OccupancyGrid& map)
    : settings_(settings), distance_m_(distance_to_occupied(map, kFieldCap_m)) {}

ScanLikelihoods BeamModel::evaluate(const LevelScan& scan, const std::vector<Pose2>& T_map_body) const {
  const std::vector<PolarBeam> beams = polar_beams(scan, settings_);
  const double best = beam_log_likelihood(1.0, 1.0, settings_);
  ScanLikelihoods result{.mean_log = std::vector<double>(T_map_body.size(), 0.0),
                         .num_beams = static_cast<int>(beams.size())};
  if (beams.empty()) return result;
  for (std::size_t i = 0; i < T_map_body.size(); ++i) {
    const Eigen::Vector2d origin = T_map_body[i] * scan.origin_m;
    double sum = 0.0;
    for (const PolarBeam& beam : beams) {
      const double expected_m = expected_range_m(origin, T_map_body[i].yaw + beam.angle_rad);
      const double max_log = beam.range_m < settings_.max_range_m ? best : 0.0;  // a density, or a probability
      sum += std::min(0.0, beam_log_likelihood(beam.range_m, expected_m, settings_) - max_log);
    }
    result.mean_log[i] = sum / static_cast<double>(beams.size());
  }
  return result;
}

// Sphere tracing [Hart96]: each step is the distance to the nearest occupied center minus one cell diagonal. Half of it
// accounts for the position within the cell, half for the extent of the wall cell.
double BeamModel::expected_range_m(const Eigen::Vector2d& p_map_origin, double angle_rad) const {
  const GridGeometry& geometry = distance_m_.geometry();
  const Eigen::Vector2d direction(std::cos(angle_rad), std::sin(angle_rad));
  const double margin_m = std::numbers::sqrt2 * geometry.resolution_m, min_step_m = 0.5 * geometry.resolution_m;
  for (double distance_m = 0.0; distance_m < settings_.max_range_m;) {
    const Cell cell = geometry.cell_at(p_map_origin + distance_m * direction);
    if (!geometry.contains(cell)) return settings_.max_range_m;
    const auto distance = static_cast<double>(distance_m_.at(cell));
    if (distance == 0.0) return distance_m;
    distance_m += std::max(min_step_m, distance - margin_m);
  }
  return settings_.max_range_m;
}

}  // namespace patrol::localize
