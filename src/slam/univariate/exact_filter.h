#pragma once

#include <cstddef>
#include <vector>

#include "slam/univariate/growth_model.h"
#include "slam/univariate/univariate_filter.h"

namespace patrol::slam {

struct ExactFilterSettings {
  double cell = 0.05;        ///< distance of two nodes
  double half_width = 40.0;  ///< nodes lie in -half_width ... half_width

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("cell", self.cell, between(0.001, 1.0));
    visit("half_width", self.half_width, between(30.0, 1000.0));
  }
};

/// The Bayes filter of the growth model, exact but for rounding: the density of the state on a dense grid, moved by the trapezoidal rule. No
/// filter that sees the observations alone has a smaller mean squared error, so that its error bounds that of all others.
///
/// Error of the discretisation: the rule converges faster than any power of the cell once the narrowest thing under the integral spans a few
/// of them. That is the transition near 0, whose slope of 25.5 makes of process noise 1 a Gaussian of standard deviation s = 0.039 in x(t-1);
/// the rule's relative error there is 2 exp(-2 (pi s / cell)^2), 1e-5 for a cell of 0.05 and 1e-21 for 0.025. The transition is cut off at
/// 8 standard deviations (1e-15), nodes of less than 1e-18 of the greatest mass send nothing.
class ExactFilter : public UnivariateFilter {
 public:
  /// Throws InputError for a denominator with minus, under which no grid is wide enough, or if a setting breaks its rule.
  explicit ExactFilter(const GrowthModel& model, const ExactFilterSettings& settings = {});

  UnivariateEstimate step(double observation) override;

  /// [node], from low to high.
  const std::vector<double>& nodes() const { return nodes_; }
  /// [node], per unit of the state; sums to 1 / cell.
  const std::vector<double>& density() const { return density_; }

 private:
  void spread(double mean, double mass, std::vector<double>& predicted) const;
  std::vector<double> predict() const;

  GrowthModel model_;
  double cell_;
  int steps_ = 0;
  std::vector<double> nodes_, density_;
  std::vector<double> bell_;  ///< [nodes from the middle], exp(-k^2 cell^2 / 2 Q)
};

}  // namespace patrol::slam
