#pragma once

#include <cstddef>
#include <vector>

namespace patrol {

/// Weights with a sum of one, from their logarithms.
std::vector<double> normalized_weights(const std::vector<double>& log_weights);

/// Effective sample size 1 / sum of w^2 of weights with a sum of one: N if all are equal, 1 if one has all (Liu 1996; Doucet et al. 2001).
double effective_sample_size(const std::vector<double>& weights);

/// Systematic resampling (Thrun et al. 2005, table 4.4, "low variance sampler"): [new particle] -> index of its parent. One
/// draw, `uniform` in (0, 1), places all N pointers, so that a particle with weight w has floor or ceil of N w children.
std::vector<std::size_t> resample_systematic(const std::vector<double>& weights, double uniform);
/// Systematic resampling with a number of new particles other than that of the weights.
std::vector<std::size_t> resample_systematic(const std::vector<double>& weights, double uniform, std::size_t num_children);

}  // namespace patrol
