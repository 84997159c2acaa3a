#pragma once

#include <optional>
#include <vector>

#include "core/messages.h"
#include "score/pose/trajectory_error.h"

namespace patrol::score {

/// Quality of the localization's self-assessment: maximum error while not reported lost, minimum confidence, total time
/// reported lost. Times are in s of the run.
struct LocalizationScore {
  double max_error_m = 0.0;            ///< maximum position error while not reported lost
  double max_error_with_lost_m = 0.0;  ///< maximum position error, reported lost or not
  double min_confidence = 1.0;
  std::optional<double> low_confidence_at_s;  ///< time at which the confidence first fell below 0.5
  std::optional<double>
      error_exceeded_at_s;  ///< time at which the position error first exceeded 0.5 m while not reported lost
  double lost_s = 0.0;      ///< total time reported lost; a report holds until the next one
};

/// Recovery from a kidnapping.
struct RelocalizationScore {
  double at_s = 0.0;            ///< time of the kidnapping
  double displacement_m = 0.0;  ///< distance between the estimated and the true position after the kidnapping
  std::optional<double> time_to_detect_s;  ///< time from the kidnapping to the report of lost localization
  /// time from the kidnapping to the first pose of a period of 5 s with less than 0.5 m error and not reported lost
  std::optional<double> relocalized_s;
};

/// Evaluates a whole run up to `end`. `matched` and `confidences` are ordered by time and begin when the localization
/// starts.
LocalizationScore localization_score(const std::vector<MatchedPose>& matched,
                                     const std::vector<LocalizationConfidence>& confidences, Time end);

/// Evaluates the recovery from a kidnapping at time `kidnapped` until `next`, the time of the next one, or Time::max().
RelocalizationScore relocalization_score(Time kidnapped, Time next, const std::vector<MatchedPose>& matched,
                                         const std::vector<LocalizationConfidence>& confidences);

}  // namespace patrol::score
