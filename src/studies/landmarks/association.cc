#include "studies/landmarks/association.h"

#include <limits>

namespace patrol::studies {

std::vector<int> associate(const LandmarkMap& map, const Pose2& T_map_body,
                           const std::vector<RangeBearing>& observations, const RangeBearingNoise& noise,
                           const AssociationSettings& settings) {
  std::vector<int> matches;
  matches.reserve(observations.size());
  if (settings.is_known) {
    for (const RangeBearing& observation : observations) matches.push_back(observation.landmark);
    return matches;
  }
  std::vector<bool> is_taken(map.landmarks().size(), false);
  int next_new = static_cast<int>(map.landmarks().size());
  for (const RangeBearing& observation : observations) {
    int best = kUnmatched;
    double best_density = -std::numeric_limits<double>::infinity(), nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < map.landmarks().size(); ++i) {
      const LandmarkInnovation fit = landmark_innovation(T_map_body, map.landmarks()[i], observation, noise);
      nearest = std::min(nearest, fit.squared_distance);
      if (is_taken[i] || fit.squared_distance > settings.gate || fit.log_density() <= best_density) continue;
      best = static_cast<int>(i);
      best_density = fit.log_density();
    }
    if (best != kUnmatched) is_taken[static_cast<std::size_t>(best)] = true;
    else if (nearest > settings.new_landmark) best = next_new++;
    matches.push_back(best);
  }
  return matches;
}

}  // namespace patrol::studies
