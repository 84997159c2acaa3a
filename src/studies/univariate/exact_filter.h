#pragma once

#include <cstddef>
#include <vector>

#include "studies/univariate/growth_model.h"
#include "studies/univariate/univariate_filter.h"

namespace patrol::studies {

struct ExactFilterSettings {
  double cell = 0.05;        ///< node spacing
  double half_width = 40.0;  ///< nodes cover -half_width ... half_width

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("cell", self.cell, between(0.001, 1.0));
    visit("half_width", self.half_width, between(30.0, 1000.0));
  }
};

/// Bayes filter of the growth model on a dense grid, exact except for rounding: the density is propagated by the
/// trapezoidal rule. No filter of the observations has a smaller mean squared error, so its error is a lower bound.
///
/// Discretization error: the rule converges faster than any power of the cell size once the narrowest integrand spans
/// several cells. That is the transition near 0: its slope of 25.5 maps process noise of 1 to a Gaussian of standard
/// deviation s = 0.039 in x(t-1). The relative error there is 2 exp(-2 (pi s / cell)^2): 1e-5 for a cell of 0.05 and
/// 1e-21 for 0.025. The transition is truncated at 8 standard deviations (1e-15), and nodes below 1e-18 of the maximum
/// mass are skipped.
class ExactFilter : public UnivariateFilter {
 public:
  /// Throws InputError if the denominator sign is -1, for which no grid is wide enough, or if a setting is invalid.
  explicit ExactFilter(const GrowthModel& model, const ExactFilterSettings& settings = {});

  UnivariateEstimate step(double observation) override;

  /// Node positions in ascending order, [node].
  const std::vector<double>& nodes() const { return nodes_; }
  /// Density per unit of the state, [node]; sums to 1 / cell.
  const std::vector<double>& density() const { return density_; }

 private:
  void spread(double mean, double mass, std::vector<double>& predicted) const;
  std::vector<double> predict() const;

  GrowthModel model_;
  double cell_;
  int steps_ = 0;
  std::vector<double> nodes_, density_;
  std::vector<double> bell_;  ///< [offset in nodes], exp(-k^2 cell^2 / 2 Q)
};

}  // namespace patrol::studies
