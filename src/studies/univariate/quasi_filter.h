#pragma once

#include <cstdint>
#include <vector>

#include "core/random.h"
#include "studies/univariate/growth_model.h"
#include "studies/univariate/univariate_filter.h"

namespace patrol::studies {

struct QuasiFilterSettings {
  int particles = 100;
  /// True: auxiliary particle filter that uses the newest observation in selection and proposal; false: bootstrap
  /// filter with quasi-random points.
  bool use_auxiliary = true;
  /// Factor on the proposal variance with `use_auxiliary`: wide tails keep the weights bounded.
  double proposal_inflation = 1.5;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("particles", self.particles, between(1, 1'000'000));
    visit("use_auxiliary", self.use_auxiliary);
    visit("proposal_inflation", self.proposal_inflation, between(1.0, 10.0));
  }
};

/// Sequential quasi-Monte Carlo [Gerber15] for the growth model. Instead of two independent random numbers for parent
/// and noise, each particle has one point of a low-discrepancy set in the unit square. Particles are sorted, so that
/// neighboring points have neighboring parents. The i-th of N points is ((i + s) / N, frac(i phi + s')), phi the golden
/// section. This lattice has low discrepancy for any N, and its first coordinates are sorted. The shifts s, s' are
/// sampled in each step, which keeps all sums unbiased.
///
/// With `use_auxiliary` [Pitt99], parents are selected by weight times p(y | parent). y is approximated as normal with
/// mean (m^2 + Q) / 20 and variance R + m^2 Q / 100 + Q^2 / 200, m = f(parent). x is sampled from an approximation of
/// p(x | parent, y), an extended Kalman filter update with one Gauss-Newton iteration. The weights correct for both
/// approximations.
///
/// Deviations from [Gerber15]:
/// - the points form that lattice, not a scrambled Sobol sequence;
/// - particles are sorted by f(parent), on which alone the next state depends, not by the parent.
/// One linearization is insufficient where the model diverges (denominator_sign -1); there it is no better than other
/// filters.
class QuasiFilter : public UnivariateFilter {
 public:
  /// Throws InputError if a setting is invalid.
  QuasiFilter(const QuasiFilterSettings& settings, const GrowthModel& model, std::uint64_t seed);

  UnivariateEstimate step(double observation) override;

  /// States of the particles, [particle].
  const std::vector<double>& states() const { return states_; }
  const std::vector<double>& weights() const { return weights_; }

 private:
  /// Parent candidate with the proposal distribution of its offspring.
  struct Branch {
    double expected = 0.0;  ///< f(parent)
    double proposal_mean = 0.0, proposal_std = 1.0;
    double log_evidence = 0.0;  ///< approximation of log p(y | parent)
    double weight = 0.0;        ///< selection probability of the parent
  };

  Branch make_branch(double expected, double observation) const;
  std::vector<Branch> make_branches(double observation) const;
  double log_weight(const Branch& branch, double state, double observation) const;

  QuasiFilterSettings settings_;
  GrowthModel model_;
  RandomStream shifts_;
  int steps_ = 0;
  std::vector<double> states_, log_weights_, weights_;
};

}  // namespace patrol::studies
