#include "score/pose/localization_score.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace patrol::score {
namespace {

constexpr double kMaxAcceptedError_m = 0.5;
constexpr double kLowConfidence = 0.5;
constexpr Time kStablePeriod = std::chrono::seconds(5);

/// Newest confidence up to `stamp`, null before the first one.
const LocalizationConfidence* newest_confidence(const std::vector<LocalizationConfidence>& confidences, Time stamp) {
  const auto after =
      std::upper_bound(confidences.begin(), confidences.end(), stamp,
                       [](Time time, const LocalizationConfidence& confidence) { return time < confidence.stamp; });
  return after == confidences.begin() ? nullptr : &*std::prev(after);
}

}  // namespace

LocalizationScore localization_score(const std::vector<MatchedPose>& matched,
                                     const std::vector<LocalizationConfidence>& confidences, Time end) {
  LocalizationScore score;
  for (std::size_t i = 0; i < confidences.size(); ++i) {
    score.min_confidence = std::min(score.min_confidence, confidences[i].confidence);
    if (confidences[i].confidence < kLowConfidence && !score.low_confidence_at_s)
      score.low_confidence_at_s = to_seconds(confidences[i].stamp);
    if (!confidences[i].is_lost) continue;
    const Time until = i + 1 < confidences.size() ? confidences[i + 1].stamp : std::max(end, confidences[i].stamp);
    score.lost_s += to_seconds(until - confidences[i].stamp);
  }
  for (const MatchedPose& pose : matched) {
    score.max_error_with_lost_m = std::max(score.max_error_with_lost_m, pose.position_error_m());
    const LocalizationConfidence* confidence = newest_confidence(confidences, pose.stamp);
    if (confidence == nullptr || confidence->is_lost) continue;
    score.max_error_m = std::max(score.max_error_m, pose.position_error_m());
    if (pose.position_error_m() > kMaxAcceptedError_m && !score.error_exceeded_at_s)
      score.error_exceeded_at_s = to_seconds(pose.stamp);
  }
  return score;
}

RelocalizationScore relocalization_score(Time kidnapped, Time next, const std::vector<MatchedPose>& matched,
                                         const std::vector<LocalizationConfidence>& confidences) {
  RelocalizationScore score{.at_s = to_seconds(kidnapped), .time_to_detect_s = {}, .relocalized_s = {}};
  for (const LocalizationConfidence& confidence : confidences) {
    if (confidence.stamp >= next) break;
    if (confidence.stamp < kidnapped || !confidence.is_lost) continue;
    score.time_to_detect_s = to_seconds(confidence.stamp - kidnapped);
    break;
  }
  constexpr Time kNever = Time::max();
  Time good_since = kNever;
  bool is_first = true;
  for (const MatchedPose& pose : matched) {
    if (pose.stamp >= next) break;
    if (pose.stamp < kidnapped) continue;
    if (std::exchange(is_first, false)) score.displacement_m = pose.position_error_m();
    const LocalizationConfidence* confidence = newest_confidence(confidences, pose.stamp);
    const bool is_good = pose.position_error_m() < kMaxAcceptedError_m && confidence != nullptr && !confidence->is_lost;
    if (!is_good) good_since = kNever;
    if (is_good) good_since = std::min(good_since, pose.stamp);
    if (good_since == kNever || pose.stamp - good_since < kStablePeriod) continue;
    score.relocalized_s = to_seconds(good_since - kidnapped);
    break;
  }
  return score;
}

}  // namespace patrol::score
