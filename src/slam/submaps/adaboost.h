#pragma once

#include <vector>

#include "core/boosted_stumps.h"
#include "core/settings.h"

namespace patrol::slam {

struct AdaBoostSettings {
  int rounds = 60;               ///< at most so many stumps
  bool balance_classes = false;  ///< both classes weigh the same at the start, however many there are of each; else every example does

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("rounds", self.rounds, between(1, 100000));
    visit("balance_classes", self.balance_classes);
  }
};

/// What is to be learnt from.
struct LabelledFeatures {
  std::vector<std::string> names;            ///< [feature]
  std::vector<std::vector<double>> examples; ///< [example][feature], finite
  std::vector<int> labels;                   ///< [example], +1 or -1, both at least once
};

struct BoostingResult {
  BoostedStumps model;
  std::vector<double> errors;   ///< [stump]: its share of wrong votes, each example weighed as it was in that round; below 1/2
  double training_error = 0.0;  ///< share of the examples that all stumps together have wrong (a tie is), by their weights at the start
  double error_bound = 1.0;     ///< product over the stumps of 2 sqrt(e (1 - e)), which the training error cannot exceed
};

/// Discrete AdaBoost over decision stumps (Freund, Schapire, "A decision-theoretic generalization of on-line learning and an application to boosting",
/// J. Comput. Syst. Sci. 1997; the bound is its theorem 6). Each round takes the stump with the fewest wrong votes by weight, of equals the one of the first
/// feature and the lowest threshold, and then weighs the examples anew, those that it had wrong as half of all. Thresholds lie midway between
/// neighbouring values, one below them all. Ends early when a stump has nothing wrong, whose vote then outweighs all others, or when none is better than
/// chance. Throws InputError when the examples are not as said above.
BoostingResult train_adaboost(const LabelledFeatures& training, const AdaBoostSettings& settings);

}  // namespace patrol::slam
