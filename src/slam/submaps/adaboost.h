#pragma once

#include <vector>

#include "core/boosted_stumps.h"
#include "core/settings.h"

namespace patrol::slam {

struct AdaBoostSettings {
  int rounds = 60;               ///< maximum number of stumps
  bool balance_classes = false;  ///< true: both classes have equal total initial weight; false: all examples do

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("rounds", self.rounds, between(1, 100000));
    visit("balance_classes", self.balance_classes);
  }
};

/// Training set of labeled feature vectors.
struct LabeledFeatures {
  std::vector<std::string> names;             ///< [feature]
  std::vector<std::vector<double>> examples;  ///< [example][feature], finite
  std::vector<int> labels;                    ///< [example], +1 or -1, each at least once
};

struct BoostingResult {
  BoostedStumps model;
  std::vector<double> errors;  ///< [stump], weighted error in its boosting round; below 1/2
  /// Weighted fraction of examples misclassified by the model, with the initial weights; ties are errors.
  double training_error = 0.0;
  double error_bound = 1.0;  ///< upper bound of the training error: product over the stumps of 2 sqrt(e (1 - e))
};

/// Discrete AdaBoost over decision stumps; the error bound is theorem 6 of [Freund97]. Each round selects the stump of
/// smallest weighted error; among equal ones that of the first feature and the lowest threshold. It then scales the
/// weights so that the misclassified examples have half of the total. Thresholds are midway between neighboring values,
/// plus one below all values. Training ends early after a stump without errors, whose weight then exceeds the sum of
/// all others, or if no stump is better than chance. Throws InputError if the training set violates its description.
BoostingResult train_adaboost(const LabeledFeatures& training, const AdaBoostSettings& settings);

}  // namespace patrol::slam
