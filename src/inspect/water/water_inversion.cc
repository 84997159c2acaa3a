#include "inspect/water/water_inversion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "core/particle_weights.h"
#include "core/random.h"
#include "inspect/water/sounding_likelihood.h"

namespace patrol::inspect {
namespace {

constexpr double kNever = -std::numeric_limits<double>::infinity();

/// Elements: ln rock, ln distance, y/x and z/x of the direction in body, ln radius, ln conductivity of the water.
using Parameters = Eigen::Matrix<double, 6, 1>;

struct Body {
  double rock_spm;
  ConductiveSphere sphere;
  Eigen::Vector3d direction;  ///< unit vector from the coil, in body
};

Body body_of(const Parameters& p) {
  return {.rock_spm = std::exp(p[0]),
          .sphere = {.distance_m = std::exp(p[1]), .radius_m = std::exp(p[4]), .conductivity_spm = std::exp(p[5])},
          .direction = Eigen::Vector3d(1.0, p[2], p[3]).normalized()};
}

Parameters sample_prior(const WaterPriorSettings& prior, RandomSequence& random) {
  const auto between = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  while (true) {
    const double cosine = between(std::cos(prior.max_angle_deg * kDegree), 1.0);
    const double turn = between(0.0, 2.0 * std::numbers::pi), tangent = std::sqrt(1.0 - cosine * cosine) / cosine;
    Parameters p;
    p << between(std::log(prior.min_rock_spm), std::log(prior.max_rock_spm)),
        std::log(prior.max_distance_m) + std::log(random.uniform()) / 3.0, tangent * std::cos(turn),
        tangent * std::sin(turn), between(std::log(prior.min_radius_m), std::log(prior.max_radius_m)),
        std::log(prior.water_spm) + prior.water_log_std * random.normal();
    if (std::exp(p[1]) > std::exp(p[4]) + prior.min_clearance_m) return p;
  }
}

/// Returns the logarithm of the density sampled by `sample_prior`, up to a constant.
double log_prior(const WaterPriorSettings& prior, const Parameters& p) {
  if (p[0] < std::log(prior.min_rock_spm) || p[0] > std::log(prior.max_rock_spm)) return kNever;
  if (p[4] < std::log(prior.min_radius_m) || p[4] > std::log(prior.max_radius_m)) return kNever;
  if (p[1] > std::log(prior.max_distance_m) || std::exp(p[1]) <= std::exp(p[4]) + prior.min_clearance_m) return kNever;
  const double secant_squared = 1.0 + p[2] * p[2] + p[3] * p[3];
  if (secant_squared > std::pow(std::cos(prior.max_angle_deg * kDegree), -2)) return kNever;
  const double water = (p[5] - std::log(prior.water_spm)) / prior.water_log_std;
  // Volume element: R^2 dR = R^3 d ln R. Solid angle element: d(y/x) d(z/x) / sec^3.
  return 3.0 * p[1] - 1.5 * std::log(secant_squared) - 0.5 * water * water;
}

struct Particle {
  Parameters p;
  double log_prior, log_likelihood;
};

struct Posterior {
  std::vector<Particle> particles;  ///< equally weighted
  double log_evidence = 0.0;
};

/// Returns ln of the mean of e^values.
double log_mean_exp(const std::vector<double>& values) {
  const double top = *std::max_element(values.begin(), values.end());
  double sum = 0.0;
  for (const double value : values) sum += std::exp(value - top);
  return top + std::log(sum / static_cast<double>(values.size()));
}

/// Returns the effective sample size for weights e^(step ln L), as a fraction: (sum w)^2 / (n sum w^2).
double effective_sample_fraction(const std::vector<Particle>& particles, double step) {
  double top = kNever, sum = 0.0, squares = 0.0;
  for (const Particle& particle : particles) top = std::max(top, particle.log_likelihood);
  for (const Particle& particle : particles) {
    const double weight = std::exp(step * (particle.log_likelihood - top));
    sum += weight, squares += weight * weight;
  }
  return sum * sum / (squares * static_cast<double>(particles.size()));
}

/// Returns the next step toward temperature 1, by bisection.
double next_step(const std::vector<Particle>& particles, double left) {
  constexpr double kMinSampleFraction = 0.5;
  if (effective_sample_fraction(particles, left) >= kMinSampleFraction) return left;
  double low = 0.0, high = left;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (effective_sample_fraction(particles, middle) >= kMinSampleFraction ? low : high) = middle;
  }
  return low;
}

/// Systematic resampling by weights e^(step ln L); `log_weights` are step ln L.
std::vector<Particle> resampled(const std::vector<Particle>& particles, const std::vector<double>& log_weights,
                                double offset) {
  std::vector<Particle> chosen;
  chosen.reserve(particles.size());
  for (const std::size_t parent : systematic_parents(normalized_weights(log_weights), offset))
    chosen.push_back(particles[parent]);
  return chosen;
}

/// Returns the Cholesky factor of the covariance of the particles, regularized by a small isotropic part.
Eigen::Matrix<double, 6, 6> covariance_factor(const std::vector<Particle>& particles) {
  Parameters mean = Parameters::Zero();
  for (const Particle& particle : particles) mean += particle.p / static_cast<double>(particles.size());
  Eigen::Matrix<double, 6, 6> covariance = 1e-10 * Eigen::Matrix<double, 6, 6>::Identity();
  for (const Particle& particle : particles) {
    const Parameters d = particle.p - mean;
    covariance += d * d.transpose() / static_cast<double>(particles.size());
  }
  return covariance.llt().matrixL();
}

/// Applies Metropolis steps of several widths to each particle: no single width suits a curved posterior.
template <typename LogLikelihood>
void move(std::vector<Particle>& particles, double temperature, const WaterSettings& settings,
          const LogLikelihood& log_likelihood, RandomSequence& random) {
  // Factors on the Cholesky factor; 2.38 / sqrt(6) = 0.97 is optimal for a normal posterior.
  constexpr double kWidths[] = {1.6, 0.8, 0.3};
  const Eigen::Matrix<double, 6, 6> factor = covariance_factor(particles);
  for (Particle& particle : particles) {
    for (int step = 0; step < settings.mcmc_steps; ++step) {
      Parameters normals;
      for (double& normal : normals) normal = random.normal();
      const double level = std::log(random.uniform());
      const Parameters p = particle.p + kWidths[random.index(std::size(kWidths))] * (factor * normals);
      const double prior = log_prior(settings.prior, p);
      if (prior == kNever) continue;
      const double likelihood = log_likelihood(p);
      if (level > prior - particle.log_prior + temperature * (likelihood - particle.log_likelihood)) continue;
      particle = {p, prior, likelihood};
    }
  }
}

template <typename LogLikelihood>
Posterior sample(const WaterSettings& settings, const LogLikelihood& log_likelihood, RandomSequence& random) {
  Posterior posterior;
  for (int i = 0; i < settings.particles; ++i) {
    const Parameters p = sample_prior(settings.prior, random);
    posterior.particles.push_back({p, log_prior(settings.prior, p), log_likelihood(p)});
  }
  for (double temperature = 0.0; temperature < 1.0;) {
    const double step = next_step(posterior.particles, 1.0 - temperature);
    std::vector<double> log_weights;
    for (const Particle& particle : posterior.particles) log_weights.push_back(step * particle.log_likelihood);
    posterior.log_evidence += log_mean_exp(log_weights);
    temperature = step >= 1.0 - temperature ? 1.0 : temperature + step;
    posterior.particles = resampled(posterior.particles, log_weights, random.uniform());
    move(posterior.particles, temperature, settings, log_likelihood, random);
  }
  return posterior;
}

struct RockAlone {
  double log_evidence, mean_spm;
};

/// Evaluates rock alone by a sum over its conductivity, on a grid finer than the gain uncertainty.
RockAlone rock_alone(const WaterPriorSettings& prior, const SoundingLikelihood& likelihood) {
  constexpr int kSteps = 3000;
  std::vector<double> rocks_spm, values;
  for (int i = 0; i < kSteps; ++i) {
    rocks_spm.push_back(prior.min_rock_spm * std::pow(prior.max_rock_spm / prior.min_rock_spm, (i + 0.5) / kSteps));
    values.push_back(likelihood.log_likelihood_rock(rocks_spm.back()));
  }
  const double log_evidence = log_mean_exp(values);
  double mean_spm = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const auto at = static_cast<std::size_t>(i);
    mean_spm += rocks_spm[at] * std::exp(values[at] - log_evidence) / kSteps;
  }
  return {log_evidence, mean_spm};
}

struct Interval {
  double low, high;
};

Interval interval_95(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double quantile) {
    const double rank = quantile * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(rank);
    return std::lerp(values[below], values[std::min(below + 1, values.size() - 1)], rank - std::floor(rank));
  };
  return {at(0.025), at(0.975)};
}

WarningLevel level_of(const WaterSettings& settings, double nearest_m) {
  if (nearest_m <= settings.alarm_distance_m) return WarningLevel::kAlarm;
  return nearest_m <= settings.warning_distance_m ? WarningLevel::kWarning : WarningLevel::kNotice;
}

/// Computes the body fields of the result from the particles.
void describe_body(const std::vector<Particle>& particles, const WaterSettings& settings,
                   const AntennaGeometry& antenna, WaterResult& result) {
  const auto count = static_cast<double>(particles.size());
  const Pose3 T_map_level = to_pose3(result.T_map_body);
  std::vector<double> distances_m, radii_m, nearest_m;
  Eigen::Vector3d p_coil_mean = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3d> positions;
  result.rock_spm = 0.0;
  for (const Particle& particle : particles) {
    const Body body = body_of(particle.p);
    positions.emplace_back(body.sphere.distance_m * body.direction);
    p_coil_mean += positions.back() / count;
    distances_m.push_back(body.sphere.distance_m);
    radii_m.push_back(body.sphere.radius_m);
    nearest_m.push_back(body.sphere.distance_m - body.sphere.radius_m);
    result.rock_spm += body.rock_spm / count;
  }
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : positions) covariance += (p - p_coil_mean) * (p - p_coil_mean).transpose() / count;
  // The misalignment of the antenna rotates the body position about it.
  const double across_std_m = settings.alignment_std_deg * kDegree * p_coil_mean.norm();
  const Eigen::Vector3d ahead = p_coil_mean.normalized();
  covariance += across_std_m * across_std_m * (Eigen::Matrix3d::Identity() - ahead * ahead.transpose());

  const Eigen::Matrix3d R = T_map_level.rotation.toRotationMatrix();
  result.p_map = T_map_level * (antenna.T_body_mount.position + p_coil_mean);
  result.covariance_m2 = R * covariance * R.transpose();
  result.distance_m = std::accumulate(distances_m.begin(), distances_m.end(), 0.0) / count;
  result.radius_m = std::accumulate(radii_m.begin(), radii_m.end(), 0.0) / count;
  const Interval distance = interval_95(distances_m), radius = interval_95(radii_m);
  result.distance_low_m = distance.low, result.distance_high_m = distance.high;
  result.radius_low_m = radius.low, result.radius_high_m = radius.high;
  result.azimuth_deg = std::atan2(p_coil_mean.y(), p_coil_mean.x()) / kDegree;
  result.elevation_deg = std::atan2(p_coil_mean.z(), p_coil_mean.head<2>().norm()) / kDegree;
  result.level = level_of(settings, interval_95(nearest_m).low);
}

void check(const WaterPriorSettings& prior) {
  if (prior.min_rock_spm >= prior.max_rock_spm) {
    throw InputError(
        fmt::format("stack.inspection.water.prior.min_rock_spm = {}: must be below max_rock_spm", prior.min_rock_spm));
  }
  if (prior.min_radius_m >= prior.max_radius_m) {
    throw InputError(
        fmt::format("stack.inspection.water.prior.min_radius_m = {}: must be below max_radius_m", prior.min_radius_m));
  }
  if (prior.max_distance_m <= prior.max_radius_m + prior.min_clearance_m) {
    throw InputError(
        fmt::format("stack.inspection.water.prior.max_distance_m = {}: must exceed the distance that a body of "
                    "max_radius_m requires",
                    prior.max_distance_m));
  }
}

}  // namespace

WaterInversion::WaterInversion(const WaterSettings& settings) : settings_(settings) {
  validate(settings, "stack.inspection.water");
  check(settings.prior);
}

WaterResult WaterInversion::invert(const std::vector<OrientedSounding>& soundings, const AntennaGeometry& antenna,
                                   const Pose2& T_map_body, double antenna_error_deg, std::uint64_t seed) const {
  WaterResult result;
  result.T_map_body = T_map_body;
  result.soundings = static_cast<int>(soundings.size());
  result.antenna_error_deg = antenna_error_deg;
  if (soundings.empty()) return result;
  result.stamp = soundings.back().sounding.stamp;

  const SoundingLikelihood likelihood(settings_.errors, soundings);
  const Eigen::Quaterniond R_mount_body = antenna.T_body_mount.rotation.conjugate();
  RandomSequence random(RandomStream(seed, "water/posterior"), 0);
  const auto log_likelihood = [&](const Parameters& p) {
    const Body body = body_of(p);
    return likelihood.log_likelihood_body(body.rock_spm, body.sphere, R_mount_body * body.direction);
  };
  const RockAlone rock = rock_alone(settings_.prior, likelihood);
  const Posterior posterior = sample(settings_, log_likelihood, random);
  result.rock_spm = rock.mean_spm;
  result.evidence = posterior.log_evidence - rock.log_evidence;
  result.is_found = result.evidence >= settings_.min_evidence;
  if (result.is_found) describe_body(posterior.particles, settings_, antenna, result);
  return result;
}

}  // namespace patrol::inspect
