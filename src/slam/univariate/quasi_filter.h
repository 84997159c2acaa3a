#pragma once

#include <cstdint>
#include <vector>

#include "core/random.h"
#include "slam/univariate/growth_model.h"
#include "slam/univariate/univariate_filter.h"

namespace patrol::slam {

struct QuasiFilterSettings {
  int particles = 100;
  bool looks_ahead = true;           ///< chooses and draws with the newest observation in view; else a bootstrap filter with quasi-random points
  double proposal_inflation = 1.5;   ///< of the proposal's variance when looking ahead: tails wide enough that no weight grows without bound

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("particles", self.particles, between(1, 1'000'000));
    visit("looks_ahead", self.looks_ahead);
    visit("proposal_inflation", self.proposal_inflation, between(1.0, 10.0));
  }
};

/// Sequential quasi-Monte Carlo (Gerber, Chopin, "Sequential quasi-Monte Carlo", JRSS-B 77, 2015) for the growth model: instead of a random number
/// for its parent and another for its noise, each particle has one point of an even set in the unit square. Particles stand in order, so that
/// points side by side have parents side by side. The i-th of N points is ((i + s) / N, frac(i phi + s')), phi the golden section: a lattice of
/// low discrepancy for any N whose first coordinates come sorted; the shifts s, s' are drawn anew each step, which leaves all sums unbiased.
///
/// Looking ahead (Pitt, Shephard, "Filtering via simulation: auxiliary particle filters", JASA 1999): parents are chosen by weight times
/// p(y | parent), y being nearly normal of mean (m^2 + Q) / 20 and variance R + m^2 Q / 100 + Q^2 / 200 round m = f(parent); and x is drawn from
/// p(x | parent, y), approximated as the extended Kalman filter does after one Gauss-Newton iteration. Weights make up for both approximations.
///
/// Departures: the points are that lattice, not a scrambled Sobol sequence; the order is that of f(parent), on which alone the next state depends,
/// not that of the parent. One linearisation is too few where the model explodes (denominator_sign -1): there it is no better than others.
class QuasiFilter : public UnivariateFilter {
 public:
  /// Throws InputError if a setting breaks its rule.
  QuasiFilter(const QuasiFilterSettings& settings, const GrowthModel& model, std::uint64_t seed);

  UnivariateEstimate step(double observation) override;

  /// [particle]
  const std::vector<double>& states() const { return states_; }
  const std::vector<double>& weights() const { return weights_; }

 private:
  /// What a particle may lead to.
  struct Branch {
    double expected = 0.0;                            ///< f(parent)
    double proposal_mean = 0.0, proposal_std = 1.0;
    double log_evidence = 0.0;                        ///< about log p(y | parent)
    double weight = 0.0;                              ///< to be chosen as a parent
  };

  Branch look_ahead(double expected, double observation) const;
  std::vector<Branch> grow_branches(double observation) const;
  double log_weight(const Branch& branch, double state, double observation) const;

  QuasiFilterSettings settings_;
  GrowthModel model_;
  RandomStream shifts_;
  int steps_ = 0;
  std::vector<double> states_, log_weights_, weights_;
};

}  // namespace patrol::slam
