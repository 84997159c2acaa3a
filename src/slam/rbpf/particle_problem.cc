#include "slam/rbpf/particle_problem.h"

#include <utility>

#include <Eigen/Cholesky>

#include "core/geometry/linear_algebra.h"

namespace patrol::slam {

RbpfParticleProblem::RbpfParticleProblem(std::vector<Particle>& particles, std::vector<PoseGaussian> predictions,
                                         const std::vector<MatchPoint>& points, double likelihood_tempering,
                                         const ScanMatcherSettings& settings)
    : particles_(particles),
      predictions_(std::move(predictions)),
      points_(points),
      likelihood_tempering_(likelihood_tempering),
      settings_(settings),
      positions_(particles.size()) {
  for (const PoseGaussian& prediction : predictions_) roots_.push_back(cholesky_factor(prediction.covariance));
}

Position RbpfParticleProblem::sample(std::size_t, RandomSequence& random) {
  const double x = random.normal(), y = random.normal(), yaw = random.normal();
  return Eigen::Vector3d(x, y, yaw);
}

double RbpfParticleProblem::log_fitness(std::size_t particle, const Position& position) const {
  return likelihood_tempering_ *
         scan_log_likelihood(particles_[particle].map, points_, pose_at(particle, position), settings_);
}

double RbpfParticleProblem::commit(std::size_t particle, const Position& position) {
  positions_[particle] = position;
  particles_[particle].T_map_body = pose_at(particle, position);
  return log_fitness(particle, position);
}

void RbpfParticleProblem::apply_resampling(const std::vector<Offspring>& offspring) {
  std::vector<Particle> children;
  for (const Offspring& child : offspring) {
    const std::size_t source = child.attraction > 0.0 ? child.attractor : child.parent;
    Particle& particle = children.emplace_back(particles_[source]);
    if (child.attraction == 0.0 && child.mutation == 0.0) continue;
    const Position own = positions_[child.parent];
    particle.T_map_body =
        pose_at(source, (1.0 + child.mutation) * (own + child.attraction * (positions_[source] - own)));
  }
  particles_ = std::move(children);
}

}  // namespace patrol::slam
