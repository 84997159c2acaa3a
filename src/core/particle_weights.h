#pragma once

#include <cstddef>
#include <vector>

namespace patrol {

/// Converts log weights to weights that sum to one.
std::vector<double> normalized_weights(const std::vector<double>& log_weights);

/// Effective sample size, 1 / sum of w^2 for weights that sum to one: N if all are equal, 1 if one particle has all the
/// weight [Liu96], [Doucet01].
double effective_sample_size(const std::vector<double>& weights);

/// Systematic resampling [Thrun05, table 4.4, "low variance sampler"]. Returns [new particle] -> index of its parent.
/// One random number, `uniform` in (0, 1), places all N pointers: a particle of weight w has floor or ceil of N w
/// children.
std::vector<std::size_t> systematic_parents(const std::vector<double>& weights, double uniform);
/// Systematic resampling with a given number of new particles.
std::vector<std::size_t> systematic_parents(const std::vector<double>& weights, double uniform,
                                            std::size_t num_children);

}  // namespace patrol
