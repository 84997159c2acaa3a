#pragma once

#include <cstdint>
#include <vector>

#include "core/settings.h"
#include "slam/submaps/adaboost.h"
#include "slam/submaps/submap_rbpf.h"

namespace patrol::slam {

struct NeighbourExampleSettings {
  int predictions = 3;                ///< of each pair that may be asked about
  double min_prediction_std_m = 0.05; ///< how far off a pair's place is predicted: drawn between these, evenly by the logarithm
  double max_prediction_std_m = 3.0;
  double prediction_rad_per_m = 0.05; ///< and its heading, of that
  double blunder_share = 0.2;         ///< of the predictions are off by four times what they say
  double max_match_m = 0.3;           ///< a match this near to the truth is right
  double max_match_rad = 0.05;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("predictions", self.predictions, between(1, 1000));
    visit("min_prediction_std_m", self.min_prediction_std_m, between(0.001, 100.0));
    visit("max_prediction_std_m", self.max_prediction_std_m, between(0.001, 100.0));
    visit("prediction_rad_per_m", self.prediction_rad_per_m, between(1e-6, 1.0));
    visit("blunder_share", self.blunder_share, between(0.0, 1.0));
    visit("max_match_m", self.max_match_m, between(0.001, 10.0));
    visit("max_match_rad", self.max_match_rad, between(1e-4, 3.2));
  }
};

/// Adds examples of pairs of submaps, by their features (pair_features.h), where the truth of their places is known: neighbours (+1) are those whose match
/// from the prediction on is right, all others are not (-1). So what is learnt is whom the matching can join, not who happens to overlap.
///
/// Predictions are the truth and an error as large as the prediction says, or, for some, much larger. Pairs that lie so far apart that nobody would ask are
/// left out. `T_world_submap` [submap that is full].
void add_neighbour_examples(const SubmapRbpf& built, const std::vector<Pose2>& T_world_submap, const NdtSettings& ndt, const NeighbourExampleSettings& settings,
                            std::uint64_t seed, LabelledFeatures& examples);

}  // namespace patrol::slam
