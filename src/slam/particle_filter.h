#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/particle_weights.h"
#include "slam/particle_filter_parts.h"

namespace patrol::slam {

/// Set of particles at one step of an estimation problem, with the state to be estimated and the newest observation.
template <typename Problem>
concept ParticleProblem = requires(Problem problem, const Problem& seen, std::size_t particle, const Position& position, RandomSequence& random,
                                   const std::vector<Offspring>& offspring) {
  { seen.size() } -> std::convertible_to<std::size_t>;
  /// Sample of the particle's proposal distribution.
  { seen.draw(particle, random) } -> std::convertible_to<Position>;
  /// Objective of the swarm optimizer, for one particle at a position.
  { seen.log_fitness(particle, position) } -> std::convertible_to<double>;
  /// Moves the particle to the position, includes the observation and returns the increment of its log weight.
  { problem.settle(particle, position) } -> std::convertible_to<double>;
  problem.reproduce(offspring);
};

/// Samples, optimizes and weights every particle. `log_weights` [particle] are accumulated from step to step.
template <ParticleProblem Problem>
void advance_particles(Problem& problem, const ParticleFilterParts& parts, RandomSequence& random, std::vector<double>& log_weights) {
  std::vector<Position> positions;
  positions.reserve(problem.size());
  for (std::size_t i = 0; i < problem.size(); ++i) positions.push_back(problem.draw(i, random));
  if (parts.optimizer) {
    const Fitness judge = [&](std::size_t particle, const Position& position) { return problem.log_fitness(particle, position); };
    Swarm swarm = make_swarm(std::move(positions), judge);
    parts.optimizer->move(swarm, judge, random);
    positions = std::move(swarm.positions);
  }
  for (std::size_t i = 0; i < problem.size(); ++i) log_weights[i] += problem.settle(i, positions[i]);
}

/// Resamples if the effective sample size is below the threshold; returns whether it did. `weights` are the normalized
/// weights that correspond to `log_weights`, which are reset to zero.
template <ParticleProblem Problem>
bool renew_particles(Problem& problem, const ParticleFilterParts& parts, const std::vector<double>& weights, RandomSequence& random,
                     std::vector<double>& log_weights) {
  if (effective_sample_size(weights) >= parts.resample_threshold * static_cast<double>(weights.size())) return false;
  problem.reproduce(parts.resample(weights, random));
  std::fill(log_weights.begin(), log_weights.end(), 0.0);
  return true;
}

}  // namespace patrol::slam
