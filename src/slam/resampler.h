#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "core/random.h"

namespace patrol::slam {

/// What a new particle is made of: a copy of `parent`, which may then be drawn towards another, or be shaken.
struct Offspring {
  std::size_t parent = 0;
  std::size_t toward = 0;     ///< the state is parent + share (toward - parent)
  double share = 0.0;
  double mutation = 0.0;      ///< the state, or what it was moved by, is multiplied by 1 + this
};

/// [new particle], as many as there are weights, which sum to one. All have equal weight afterwards.
using Resampler = std::function<std::vector<Offspring>(const std::vector<double>& weights, RandomSequence& random)>;

/// Each new particle draws its parent by itself (Gordon, Salmond, Smith 1993). Unbiased: the mean number of children is N w.
std::vector<Offspring> resample_multinomially(const std::vector<double>& weights, RandomSequence& random);

/// One draw for all (core/particle_weights.h). Unbiased.
std::vector<Offspring> resample_evenly(const std::vector<double>& weights, RandomSequence& random);

/// floor(N w) children for certain, the rest drawn from what is left over (Liu, Chen 1998). Unbiased.
std::vector<Offspring> resample_by_residuals(const std::vector<double>& weights, RandomSequence& random);

/// "Optimisation of low weights" of paper 000, eqs. 3, 4: the M heaviest particles stay, M the largest integer below N_eff; every other is
/// drawn by a random share towards a random one of those. Biased: whatever their weights, the M count alike, and nothing that is copied
/// is a draw from the weighted set.
std::vector<Offspring> draw_low_weights_up(const std::vector<double>& weights, RandomSequence& random);

struct StepwiseResampling {
  double averaging = 0.8;       ///< beta of eq. 7
  double mutation_std = 0.01;   ///< mu of eq. 8
};

/// Stepwise resampling of paper 001, eqs. 7, 8. The weights in falling order are averaged exponentially from the heaviest on,
/// v_i = beta v_(i-1) + (1 - beta) w_i, delta_i = v_i / (1 - beta^i) (eq. 7 prints delta on both sides, which would divide by the correction
/// again and again); delta is the mean of all delta_i. Particles of w >= delta stay, w / delta times, rounded up, the heaviest first
/// as long as there is room; what is still missing are survivors in turn, shaken by a Gaussian (eq. 8). Biased: light particles never
/// survive, and every survivor's count is rounded up.
std::vector<Offspring> resample_stepwise(const std::vector<double>& weights, RandomSequence& random, const StepwiseResampling& settings = {});

}  // namespace patrol::slam
