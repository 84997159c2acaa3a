#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "core/random.h"

namespace patrol::slam {

/// Recipe of a new particle: a copy of `parent`, optionally moved toward another particle or perturbed.
struct Offspring {
  std::size_t parent = 0;
  std::size_t attractor = 0;  ///< index of the attracting particle; state = parent + attraction (attractor - parent)
  double attraction = 0.0;
  double mutation = 0.0;  ///< relative perturbation: the state, or its increment, is multiplied by 1 + mutation
};

/// Function that maps weights, which sum to one, to an equal number of offspring [new particle] of equal weight.
using Resampler = std::function<std::vector<Offspring>(const std::vector<double>& weights, RandomSequence& random)>;

/// Multinomial resampling [Gordon93]: each new particle samples its parent independently. Unbiased: the mean number of
/// children is N w.
std::vector<Offspring> resample_multinomial(const std::vector<double>& weights, RandomSequence& random);

/// Systematic resampling with one random number for all particles (core/particle_weights.h). Unbiased.
std::vector<Offspring> resample_systematic(const std::vector<double>& weights, RandomSequence& random);

/// Residual resampling [Liu98]: floor(N w) copies of each particle, the rest sampled from the remainders. Unbiased.
std::vector<Offspring> resample_residual(const std::vector<double>& weights, RandomSequence& random);

/// Low-weight optimization of [Wu25, eqs. 3, 4]. The M particles of largest weight are kept, with M the largest integer
/// below N_eff. Every other particle is moved by a random fraction toward a random one of them. Biased: the M particles
/// count equally whatever their weights, and the moved particles are not samples of the weighted set.
std::vector<Offspring> optimize_low_weights(const std::vector<double>& weights, RandomSequence& random);

struct StepwiseResampling {
  double averaging = 0.8;      ///< beta of [Cui21, eq. 7]
  double mutation_std = 0.01;  ///< mu of [Cui21, eq. 8]
};

/// Stepwise resampling of [Cui21, eqs. 7, 8]. The weights in descending order are averaged exponentially: v_i = beta
/// v_(i-1) + (1 - beta) w_i, delta_i = v_i / (1 - beta^i). delta is the mean of all delta_i. Particles with w >= delta
/// get ceil(w / delta) copies, in descending order, until N particles exist. Missing particles are filled with copies
/// of the survivors in turn, perturbed by a Gaussian (eq. 8). Biased: particles with w < delta never survive, and the
/// number of copies is rounded up.
/// Deviation from [Cui21]: eq. 7 prints delta on both sides, which would apply the bias correction repeatedly.
std::vector<Offspring> resample_stepwise(const std::vector<double>& weights, RandomSequence& random,
                                         const StepwiseResampling& settings = {});

}  // namespace patrol::slam
