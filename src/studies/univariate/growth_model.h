#pragma once

#include <cstdint>
#include <vector>

#include "core/settings.h"

namespace patrol::studies {

struct GrowthModelSettings {
  int steps = 100;
  double initial_state = 0.0;    ///< x(0), known to every filter
  double process_var = 1.0;      ///< Q
  double observation_var = 1.0;  ///< R
  /// Sign of x^2 in the denominator [Cui21, eq. 9]: 1; or -1 as printed, which diverges near x = 1 and x = -1.
  int denominator_sign = 1;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("steps", self.steps, between(1, 100'000));
    visit("initial_state", self.initial_state);
    visit("process_var", self.process_var, between(1e-6, 1e6));
    visit("observation_var", self.observation_var, between(1e-6, 1e6));
    visit("denominator_sign", self.denominator_sign, between(-1, 1));
  }
};

/// Simulated run, [step - 1] for steps 1 ... n; x(0) is not included.
struct GrowthRun {
  std::vector<double> states;
  std::vector<double> observations;
};

/// Univariate nonstationary growth model ([Netto78], [Gordon93], [Cui21, eq. 9]), dimensionless:
///   x(t) = 0.5 x(t-1) + 25 x(t-1) / (1 + x(t-1)^2) + 8 cos(1.2 (t-1)) + w,   w ~ N(0, Q)
///   y(t) = x(t)^2 / 20 + v,                                                  v ~ N(0, R)
/// An observation does not distinguish x from -x. Deviation from [Cui21], which prints 1 - x^2 in the denominator
/// instead of 1 + x^2 as in the other sources. With the minus sign the state jumps by thousands near 1 and -1.
class GrowthModel {
 public:
  /// Throws InputError if a setting is invalid.
  explicit GrowthModel(const GrowthModelSettings& settings = {});

  /// Mean of x(step) given x(step - 1): drift(state) + forcing(step). The first step is 1.
  double transition(double state, int step) const { return drift(state) + forcing(step); }
  double drift(double state) const;
  static double forcing(int step);
  /// Mean of y given x.
  static double mean_observation(double state);
  /// Returns log p(y | x).
  double log_likelihood(double observation, double state) const;

  /// Simulates a run, reproducible by the seed.
  GrowthRun simulate(std::uint64_t seed) const;

  const GrowthModelSettings& settings() const { return settings_; }

 private:
  GrowthModelSettings settings_;
  double log_normalizer_ = 0.0;  ///< normalization term of log p(y | x)
};

}  // namespace patrol::studies
