#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace patrol {

/// Says +1 on one side of a threshold and -1 on the other.
struct DecisionStump {
  std::size_t feature = 0;
  double threshold = 0.0;
  int sign_above = 1;   ///< +1 or -1: what it says of values above the threshold
  double weight = 0.0;  ///< of its vote; positive

  int vote(const std::vector<double>& features) const { return features[feature] > threshold ? sign_above : -sign_above; }

  friend bool operator==(const DecisionStump&, const DecisionStump&) = default;
};

/// A vote of stumps (slam/submaps/adaboost.h trains them, io/adaboost_json.h keeps them).
struct BoostedStumps {
  std::vector<std::string> features;  ///< [feature]: its name, so that a model is not asked about others than it has learnt
  std::vector<DecisionStump> stumps;

  /// Share of the votes for +1 less that for -1: -1 ... 1, how sure it is; 0 without stumps. `values` [feature].
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
