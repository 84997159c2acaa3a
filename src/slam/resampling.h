#pragma once

#include <cstddef>
#include <vector>

namespace patrol::slam {

/// Weights that sum to one, from logarithms.
std::vector<double> normalized_weights(const std::vector<double>& log_weights);

/// 1 / sum of w^2 for weights of sum one: N if all are equal, 1 if one has all (Liu 1996; Doucet et al. 2001).
double effective_sample_size(const std::vector<double>& weights);

/// Systematic resampling (Thrun et al. 2005, table 4.4, "low variance sampler"): [new particle] -> index of its parent. One
/// draw, `uniform` in (0, 1), places all N pointers, so that a particle with weight w has floor or ceil of N w children.
std::vector<std::size_t> resample_systematic(const std::vector<double>& weights, double uniform);
/// The same with a number of new particles of its own.
std::vector<std::size_t> resample_systematic(const std::vector<double>& weights, double uniform, std::size_t num_children);

}  // namespace patrol::slam
