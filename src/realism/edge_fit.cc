#include "realism/edge_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include "core/geometry/angles.h"

namespace patrol::realism {
namespace {

constexpr double kStep_deg = 0.005;
constexpr int kHalf = 340, kPreviousHalf = 180;  // offsets to each side of a fan
constexpr double kAimStep_deg = 0.02;            // between the aims of a beam that the angle noise is sampled at
constexpr double kMaxWidth_deg = 2.0, kCoarse_deg = 0.05, kFine_deg = 0.005;
// Constants of the lidar model (sim/sensors/lidar.cc): number of rays of a mixed pixel, jumps with mixed pixels.
constexpr std::array<double, 4> kRays = {-0.375, -0.125, 0.125, 0.375};
constexpr double kMixedFrom_m = 0.1, kPulseLength_m = 1.5;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Ray {
  double range_m = kInfinity, light = 0.0;
};

/// Returns the reading of a ray without width and noise, as the lidar model does.
Ray trace(const Site& site, const Eigen::Vector3d& origin, const Eigen::Vector3d& along, const LidarDevice& device,
          double max_range_m) {
  const std::optional<SurfaceHit> hit = site.cast(origin, along, max_range_m);
  if (!hit) return {};
  const double cosine = std::abs(hit->normal.dot(along));
  if (hit->is_glass && cosine < 0.996) return {};
  if (cosine < std::cos(device.settings.max_incidence_deg * kDegree)) return {};
  const double limit_m = device.settings.max_range_10pct_m * std::sqrt(hit->reflectivity * std::sqrt(cosine) / 0.1);
  if (device.settings.max_range_10pct_m > 0.0 && hit->range_m > limit_m) return {};
  const double range_m = hit->range_m + device.errors.range_error_m(hit->range_m, hit->reflectivity, cosine);
  return {range_m, std::min(1.0, hit->reflectivity * cosine) / (range_m * range_m)};
}

/// Quadrature of a normal distribution: offsets in standard deviations, and weights.
using Nodes = std::vector<std::pair<double, double>>;

/// Nodes at most `max_step` standard deviations apart, up to 2.8 standard deviations.
Nodes normal_nodes(double max_step) {
  const int half = static_cast<int>(std::ceil(2.8 / std::min(0.7, max_step)));
  Nodes nodes;
  double sum = 0.0;
  for (int k = -half; k <= half; ++k) {
    const double z = 2.8 * k / half;
    nodes.emplace_back(z, std::exp(-0.5 * z * z));
    sum += nodes.back().second;
  }
  for (auto& node : nodes) node.second /= sum;
  return nodes;
}

std::size_t index_at(double offset_deg, int half) {
  return static_cast<std::size_t>(std::clamp(static_cast<int>(std::lround(offset_deg / kStep_deg)), -half, half) +
                                  half);
}

/// Mean range over the width about an offset, weighted by light.
double mixed_range_m(const EdgeSample& sample, double offset_deg, double width_deg) {
  const double middle_m = sample.range_m[index_at(offset_deg, kHalf)];
  double light = 0.0, light_range_m = 0.0;
  for (const double ray : kRays) {
    const std::size_t at = index_at(offset_deg + ray * width_deg, kHalf);
    if (!(std::abs(sample.range_m[at] - middle_m) < kPulseLength_m)) continue;
    light += sample.light[at];
    light_range_m += static_cast<double>(sample.light[at]) * sample.range_m[at];
  }
  return light > 0.0 ? light_range_m / light : middle_m;
}

double edge_density(double deviation_m, double std_m, double step_m) {
  if (step_m < 0.05 * std_m)
    return std::exp(-0.5 * deviation_m * deviation_m / (std_m * std_m)) / (std_m * std::sqrt(2.0 * std::numbers::pi));
  const double scale = std_m * std::numbers::sqrt2;
  return 0.5 * (std::erf((deviation_m + 0.5 * step_m) / scale) - std::erf((deviation_m - 0.5 * step_m) / scale)) /
         step_m;
}

/// Possible aim of a beam with its probability.
struct Aim {
  double offset_deg = 0.0;
  double probability = 0.0;
  double range_m = 0.0;           ///< range without mixing
  double jump_probability = 0.0;  ///< probability of a jump from the previous beam that mixes
};

/// Returns the aims of a sample with a return, by the angle noise of this and the previous beam.
std::vector<Aim> aims_of(const EdgeSample& sample, double angle_noise_deg, const Nodes& nodes, const Nodes& previous) {
  std::vector<Aim> aims;
  double total = 0.0;
  for (const auto& [node, weight] : nodes) {
    Aim aim{.offset_deg = node * angle_noise_deg, .probability = weight};
    aim.range_m = sample.range_m[index_at(aim.offset_deg, kHalf)];
    if (!std::isfinite(aim.range_m)) continue;  // no return: the sample is conditional on one
    for (const auto& [previous_node, previous_weight] : previous) {
      const double jump_m =
          std::abs(aim.range_m - sample.previous_m[index_at(previous_node * angle_noise_deg, kPreviousHalf)]);
      if (jump_m > kMixedFrom_m && jump_m < kPulseLength_m) aim.jump_probability += previous_weight;
    }
    aim.jump_probability = std::min(1.0, aim.jump_probability);
    total += weight;
    aims.push_back(aim);
  }
  for (Aim& aim : aims) aim.probability /= total;
  return aims;
}

/// Density of the return at one width.
double density_of(const EdgeSample& sample, const std::vector<Aim>& aims, double width_deg,
                  const LidarSettings& lidar) {
  const double noise_m = std::max(1e-4, lidar.range_noise_std_m), step_m = lidar.range_quantization_m;
  const double wide = lidar.wide_noise_probability, wide_noise_m = std::hypot(noise_m, lidar.wide_noise_std_m);
  const auto noise_density = [&](double deviation_m) {
    const double narrow = edge_density(deviation_m, noise_m, step_m);
    return wide > 0.0 ? (1.0 - wide) * narrow + wide * edge_density(deviation_m, wide_noise_m, step_m) : narrow;
  };
  double density = 0.0;
  for (const Aim& aim : aims) {
    double of_aim = 0.0;
    if (aim.jump_probability > 0.0) {
      const double mixed_m = mixed_range_m(sample, aim.offset_deg, width_deg);
      of_aim += aim.jump_probability * noise_density(sample.recorded_m - mixed_m);
    }
    if (aim.jump_probability < 1.0)
      of_aim += (1.0 - aim.jump_probability) * noise_density(sample.recorded_m - aim.range_m);
    const double through = std::exp(-lidar.false_return_rate_per_m * aim.range_m);
    of_aim *= through;
    if (sample.recorded_m < aim.range_m) of_aim += (1.0 - through) / aim.range_m;
    density += aim.probability * of_aim;
  }
  return density;
}

/// Log-likelihood of all samples with the best outlier ratio (expectation-maximization), and that ratio.
std::pair<double, double> mixture_log_likelihood(const std::vector<double>& densities, double outlier_density) {
  double ratio = 0.02;
  for (int k = 0; k < 15; ++k) {
    double sum = 0.0;
    for (const double density : densities) {
      const double outlier = ratio * outlier_density;
      sum += outlier / (outlier + (1.0 - ratio) * density);
    }
    ratio = std::clamp(sum / static_cast<double>(densities.size()), 1e-4, 0.99);
  }
  double log_likelihood = 0.0;
  for (const double density : densities) log_likelihood += std::log(ratio * outlier_density + (1.0 - ratio) * density);
  return {log_likelihood, ratio};
}

struct EdgeValue {
  double log_likelihood = 0.0, outlier_ratio = 0.0;
};

/// Log-likelihood of a width, profiled over the angle noise.
class WidthProfile {
 public:
  WidthProfile(const std::vector<EdgeSample>& samples, const LidarSettings& lidar, const AngleNoiseRange& angle_noise)
      : samples_(samples), lidar_(lidar) {
    const auto add = [&](double noise_deg, double log_prior) {
      const Nodes nodes = noise_deg > 1e-3 ? normal_nodes(kAimStep_deg / noise_deg) : Nodes{{0.0, 1.0}};
      const Nodes previous = noise_deg > 1e-3 ? normal_nodes(0.35) : nodes;
      Noise& noise = noises_.emplace_back(Noise{.log_prior = log_prior});
      for (const EdgeSample& sample : samples) noise.aims.push_back(aims_of(sample, noise_deg, nodes, previous));
    };
    // The interval of the angle noise as a normal prior in the logarithm, or uniform up to its upper bound.
    if (angle_noise.low_deg > 0.0) {
      const double std = std::log(angle_noise.high_deg / angle_noise.low_deg) / (2.0 * 1.96);
      for (const double z : {-1.5, 0.0, 1.5}) add(angle_noise.value_deg * std::exp(z * std), -0.5 * z * z);
    } else {
      for (const double fraction : {0.05, 0.35, 0.7, 1.0}) add(fraction * angle_noise.high_deg, 0.0);
    }
  }

  EdgeValue operator()(double width_deg) const {
    EdgeValue best{.log_likelihood = -kInfinity};
    std::vector<double> densities(samples_.size());
    for (const Noise& noise : noises_) {
      for (std::size_t i = 0; i < samples_.size(); ++i)
        densities[i] = density_of(samples_[i], noise.aims[i], width_deg, lidar_);
      const auto [value, ratio] = mixture_log_likelihood(densities, 1.0 / lidar_.range_max_m);
      if (value + noise.log_prior > best.log_likelihood) best = {value + noise.log_prior, ratio};
    }
    return best;
  }

 private:
  struct Noise {
    double log_prior = 0.0;
    std::vector<std::vector<Aim>> aims = {};  ///< [sample]
  };

  const std::vector<EdgeSample>& samples_;
  LidarSettings lidar_;
  std::vector<Noise> noises_;
};

}  // namespace

EdgeSample edge_sample(const Site& site, const PosedScan& posed, const Beam& beam, const LidarDevice& device) {
  EdgeSample sample{.recorded_m = beam.recorded_m};
  const Pose3 pose = posed.pose_of(beam.index), previous = posed.pose_of(beam.index - 1);
  const double sign = posed.scan.angle_increment_rad < 0.0 ? -1.0 : 1.0;
  for (int k = -kHalf; k <= kHalf; ++k) {
    const double azimuth_rad = posed.azimuth_rad(beam.index) + sign * k * kStep_deg * kDegree;
    const Ray ray =
        trace(site, pose.position, pose.rotation * posed.direction_at(azimuth_rad), device, posed.scan.range_max_m);
    sample.range_m.push_back(static_cast<float>(ray.range_m));
    sample.light.push_back(static_cast<float>(ray.light));
  }
  for (int k = -kPreviousHalf; k <= kPreviousHalf; ++k) {
    const double azimuth_rad = posed.azimuth_rad(beam.index - 1) + sign * k * kStep_deg * kDegree;
    const Ray ray = trace(site, previous.position, previous.rotation * posed.direction_at(azimuth_rad), device,
                          posed.scan.range_max_m);
    sample.previous_m.push_back(static_cast<float>(ray.range_m));
  }
  return sample;
}

bool EdgeSample::has_both_returns() const {
  return std::isfinite(range_m[kHalf]) && std::isfinite(previous_m[kPreviousHalf]);
}

EdgeFit fit_beam_width(const std::vector<EdgeSample>& samples, const LidarDevice& device,
                       const AngleNoiseRange& angle_noise) {
  // The rays of a mixed pixel cross an edge one by one: the likelihood has steps, like that of a change point.
  constexpr double kThreshold = 3.0;
  EdgeFit fit{.high_deg = kMaxWidth_deg, .num_samples = samples.size()};
  if (samples.size() < 30) return fit;
  const WidthProfile profile(samples, device.settings, angle_noise);
  std::map<double, EdgeValue> values;
  const auto evaluate = [&](double from_deg, double to_deg, double step_deg) {
    const int count = static_cast<int>(std::lround((to_deg - from_deg) / step_deg));
    for (int k = 0; k <= count; ++k) {
      const double width_deg = std::clamp(from_deg + k * step_deg, 0.0, kMaxWidth_deg);
      if (!values.contains(width_deg)) values[width_deg] = profile(width_deg);
    }
  };
  const auto best = [&] {
    return std::ranges::max_element(values, {}, [](const auto& value) { return value.second.log_likelihood; });
  };
  evaluate(0.0, kMaxWidth_deg, kCoarse_deg);
  const double rough_deg = best()->first;
  evaluate(rough_deg - kCoarse_deg, rough_deg + kCoarse_deg, kFine_deg);
  fit.width_deg = best()->first;
  fit.outlier_ratio = best()->second.outlier_ratio;
  // Extend the fine search until both ends of the interval are in it.
  const double floor = best()->second.log_likelihood - kThreshold;
  fit.low_deg = fit.high_deg = fit.width_deg;
  double step_deg = kFine_deg;
  for (double at = fit.width_deg; at > 0.0 && profile(at).log_likelihood >= floor; step_deg *= 1.2) {
    at = std::max(0.0, at - step_deg);
    fit.low_deg = at;
  }
  step_deg = kFine_deg;
  for (double at = fit.width_deg; at < kMaxWidth_deg && profile(at).log_likelihood >= floor; step_deg *= 1.2) {
    at = std::min(kMaxWidth_deg, at + step_deg);
    fit.high_deg = at;
  }
  for (const auto& [width_deg, value] : values) {
    if (value.log_likelihood < floor) continue;
    fit.low_deg = std::min(fit.low_deg, std::max(0.0, width_deg - kFine_deg));
    fit.high_deg = std::max(fit.high_deg, std::min(kMaxWidth_deg, width_deg + kFine_deg));
  }
  // The aims of a beam are kAimStep_deg apart.
  fit.low_deg = std::max(0.0, fit.low_deg - 0.5 * kAimStep_deg);
  fit.high_deg = std::min(kMaxWidth_deg, fit.high_deg + 0.5 * kAimStep_deg);
  fit.has_upper = fit.high_deg < kMaxWidth_deg;
  return fit;
}

}  // namespace patrol::realism
