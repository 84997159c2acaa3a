#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/particle_weights.h"
#include "slam/particle_filter_components.h"

namespace patrol::slam {

/// Set of particles at one step of an estimation problem, with the state to be estimated and the newest observation.
template <typename Problem>
concept ParticleProblem = requires(Problem problem, const Problem& const_problem, std::size_t particle,
                                   const Position& position, RandomSequence& random,
                                   const std::vector<Offspring>& offspring) {
  { const_problem.size() } -> std::convertible_to<std::size_t>;
  /// Sample of the particle's proposal distribution.
  { const_problem.sample(particle, random) } -> std::convertible_to<Position>;
  /// Objective of the swarm optimizer, for one particle at a position.
  { const_problem.log_fitness(particle, position) } -> std::convertible_to<double>;
  /// Moves the particle to the position, includes the observation and returns the increment of its log weight.
  { problem.commit(particle, position) } -> std::convertible_to<double>;
  problem.apply_resampling(offspring);
};

/// Samples, optimizes and weights every particle. `log_weights` [particle] are accumulated from step to step.
template <ParticleProblem Problem>
void propagate_and_weight(Problem& problem, const ParticleFilterComponents& components, RandomSequence& random,
                          std::vector<double>& log_weights) {
  std::vector<Position> positions;
  positions.reserve(problem.size());
  for (std::size_t i = 0; i < problem.size(); ++i) positions.push_back(problem.sample(i, random));
  if (components.optimizer) {
    const Fitness fitness_of = [&](std::size_t particle, const Position& position) {
      return problem.log_fitness(particle, position);
    };
    Swarm swarm = make_swarm(std::move(positions), fitness_of);
    components.optimizer->move(swarm, fitness_of, random);
    positions = std::move(swarm.positions);
  }
  for (std::size_t i = 0; i < problem.size(); ++i) log_weights[i] += problem.commit(i, positions[i]);
}

/// Resamples if the effective sample size is below the threshold; returns whether it did. `weights` are the normalized
/// weights that correspond to `log_weights`, which are reset to zero.
template <ParticleProblem Problem>
bool resample_if_depleted(Problem& problem, const ParticleFilterComponents& components,
                          const std::vector<double>& weights, RandomSequence& random,
                          std::vector<double>& log_weights) {
  if (effective_sample_size(weights) >= components.resample_threshold * static_cast<double>(weights.size()))
    return false;
  problem.apply_resampling(components.resample(weights, random));
  std::fill(log_weights.begin(), log_weights.end(), 0.0);
  return true;
}

}  // namespace patrol::slam
