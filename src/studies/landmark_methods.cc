#include "studies/landmark_methods.h"

#include <cctype>

#include <fmt/format.h>

#include "studies/landmarks/ekf_slam.h"

namespace patrol::studies {
namespace {

LandmarkMethod particle_method(const std::string& name, const FastSlamSettings& settings,
                               const slam::ParticleFilterSettings& filter) {
  return {.name = name, .particles = settings.particles, .make = [=](const LandmarkWorld& world, std::uint64_t seed) {
            return std::make_unique<FastSlam>(settings, world.motion, world.noise, slam::make_components(filter), seed);
          }};
}

LandmarkMethod gaussian_method(const std::string& name, const EkfSlamSettings& settings) {
  return {.name = name, .particles = 0, .make = [=](const LandmarkWorld& world, std::uint64_t) {
            return std::make_unique<EkfSlam>(settings, world.motion, world.noise);
          }};
}

}  // namespace

LandmarkMethod fast_slam_1(int particles, double noise_scale) {
  const std::string name = noise_scale == 1.0 ? "FastSLAM" : fmt::format("FastSLAM, noise x {:g}", noise_scale);
  return particle_method(name, {.particles = particles, .noise_scale = noise_scale}, {});
}

LandmarkMethod fast_slam_2(int particles) {
  return particle_method("FastSLAM 2", {.particles = particles, .use_optimal_proposal = true}, {});
}

LandmarkMethod swarm_slam(const std::string& optimizer, int particles) {
  std::string name;
  for (const char c : optimizer) name += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return particle_method(name, {.particles = particles}, slam::published_settings(optimizer));
}

LandmarkMethod iscso_plus(int particles) {
  return particle_method("ISCSO+", {.particles = particles, .bias = {.std = 0.2}, .prior_weight = 0.05},
                         {.optimizer = "iscso"});
}

LandmarkMethod ekf_slam() { return gaussian_method("EKF-SLAM", {.bias = {.std = 0.0}, .is_invariant = false}); }

LandmarkMethod invariant_slam() { return gaussian_method("invariant EKF", {}); }

}  // namespace patrol::studies
