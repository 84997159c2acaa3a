#pragma once

#include <cstdint>
#include <vector>

#include "core/settings.h"
#include "slam/submaps/adaboost.h"
#include "slam/submaps/submap_rbpf.h"

namespace patrol::slam {

struct NeighborExampleSettings {
  int predictions = 3;  ///< number of predictions per submap pair
  /// Standard deviation of the predicted position, sampled between these bounds, uniform in the logarithm.
  double min_prediction_std_m = 0.05;
  double max_prediction_std_m = 3.0;
  /// Standard deviation of the predicted heading per standard deviation of the position.
  double prediction_rad_per_m = 0.05;
  double outlier_probability = 0.2;  ///< fraction of gross errors: predictions with four times the stated error
  double max_match_m = 0.15;         ///< maximum distance of a correct match from ground truth
  double max_match_rad = 0.02;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("predictions", self.predictions, between(1, 1000));
    visit("min_prediction_std_m", self.min_prediction_std_m, between(0.001, 100.0));
    visit("max_prediction_std_m", self.max_prediction_std_m, between(0.001, 100.0));
    visit("prediction_rad_per_m", self.prediction_rad_per_m, between(1e-6, 1.0));
    visit("outlier_probability", self.outlier_probability, between(0.0, 1.0));
    visit("max_match_m", self.max_match_m, between(0.001, 10.0));
    visit("max_match_rad", self.max_match_rad, between(1e-4, 3.2));
  }
};

/// Adds the features (pair_features.h) of submap pairs with labels from ground truth. Neighbors (+1) are pairs whose
/// match from the prediction is correct; all others are -1. The classifier thus learns which pairs can be matched, not
/// which overlap.
///
/// Predictions are ground truth plus an error as large as stated or, for a fraction of them, four times as large. Pairs
/// too far apart to be candidates are skipped. `T_world_submap` [full submap].
void add_neighbor_examples(const SubmapRbpf& built, const std::vector<Pose2>& T_world_submap,
                           const SubmapSurfaceSettings& surfaces, const NeighborExampleSettings& settings,
                           std::uint64_t seed, LabeledFeatures& examples);

}  // namespace patrol::slam
