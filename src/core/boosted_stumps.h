#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace patrol {

/// Weak classifier: votes +1 on one side of a threshold and -1 on the other.
struct DecisionStump {
  std::size_t feature = 0;
  double threshold = 0.0;
  int sign_above = 1;   ///< +1 or -1: vote for values above the threshold
  double weight = 0.0;  ///< weight of the vote; positive

  int vote(const std::vector<double>& features) const {
    return features[feature] > threshold ? sign_above : -sign_above;
  }

  friend bool operator==(const DecisionStump&, const DecisionStump&) = default;
};

/// Weighted vote of decision stumps [Freund97]. Trained in slam/submaps/adaboost.h, stored by io/json/adaboost_json.h.
struct BoostedStumps {
  std::vector<std::string> features;  ///< [feature]: name, checked when a model is loaded
  std::vector<DecisionStump> stumps;

  /// Returns the normalized weighted vote in [-1, 1]; 0 without stumps. Its magnitude is the confidence of the
  /// classification. `values`: [feature].
  double margin(const std::vector<double>& values) const {
    double votes = 0.0, all = 0.0;
    for (const DecisionStump& stump : stumps) {
      votes += stump.weight * stump.vote(values);
      all += stump.weight;
    }
    return all > 0.0 ? votes / all : 0.0;
  }

  friend bool operator==(const BoostedStumps&, const BoostedStumps&) = default;
};

}  // namespace patrol
