#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace patrol::realism {

/// Beam on a surface that returns or does not.
struct ReturnSample {
  double value = 0.0;  ///< quantity that the limit is on
  double blur = 0.0;   ///< standard deviation of the actual about the expected value
  bool is_return = false;
  std::size_t block = 0;  ///< group of scans
};

/// Limit beyond which beams do not return.
struct LimitFit {
  double value = 0.0;
  double low = 0.0, high = 0.0;      ///< 95 % interval
  bool has_upper = false;            ///< whether the log has an upper end; otherwise `high` is the end of the search
  double log_likelihood_gain = 0.0;  ///< gain over no limit
  std::size_t num_beyond = 0;        ///< beams beyond the limit
};

/// Fits a limit by the likelihood of returns: 1 - `dropout` below, a probability of unexplained returns of at most 0.5
/// beyond, both fitted with it. The search is from the smallest value to `end`. The interval is where the
/// log-likelihood is at most 3.0 below its maximum: a limit is a change point, whose likelihood ratio has about two
/// degrees of freedom.
LimitFit fit_limit(std::vector<ReturnSample> samples, double end);

/// Beam with the quantities of two limits.
struct TwoLimitSample {
  double first = 0.0, second = 0.0;
  bool is_return = false;
};

/// Finds roughly the pair of limits (`first_end` and `second_end`: no limit) with the highest likelihood: a beam
/// returns with one probability inside of both, and with a smaller one beyond. Steps: 1 % of `first_end`, and 5 % of
/// `second`.
std::pair<double, double> rough_limits(const std::vector<TwoLimitSample>& samples, double first_end, double second_end);

/// Fraction with its 95 % interval.
struct RateFit {
  double value = 0.0, low = 0.0, high = 1.0;
  std::size_t count = 0, total = 0;
};

/// Fits the probability of no return: Wilson's interval [Wilson27], with the variance enlarged by the ratio of the
/// variance between blocks of scans to the binomial one where this exceeds 1.
RateFit fit_dropouts(const std::vector<ReturnSample>& samples);

}  // namespace patrol::realism
