#pragma once

#include <optional>
#include <vector>

#include "core/messages.h"
#include "score/trajectory_error.h"

namespace patrol::score {

/// How well the robot knew how well it knew.
struct LocalizationScore {
  double max_error_m = 0.0;            ///< of the position, while it did not say that it was lost
  double min_trust = 1.0;
  std::optional<double> doubted_s;     ///< when its trust first fell below one half
  std::optional<double> strayed_s;     ///< when its error first passed half a metre
  double lost_s = 0.0;                 ///< in all, by its own word
};

/// After a kidnap.
struct RelocalizationScore {
  double at_s = 0.0;
  double moved_m = 0.0;                   ///< from where the robot believed itself to where it was put
  std::optional<double> said_lost_s;      ///< until it said that it was lost
  std::optional<double> relocalized_s;    ///< until it knew its place again to half a metre, and did not lose it in the next five seconds
};

/// `matched` and `trusts` in order of time; both from when localisation began.
LocalizationScore localization_score(const std::vector<MatchedPose>& matched, const std::vector<LocalizationTrust>& trusts);

RelocalizationScore relocalization_score(Time kidnapped, const std::vector<MatchedPose>& matched,
                                         const std::vector<LocalizationTrust>& trusts);

}  // namespace patrol::score
