#include "score/localization_score.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace patrol::score {
namespace {

constexpr double kStrayed_m = 0.5;
constexpr double kDoubted = 0.5;
constexpr Time kKeeps = std::chrono::seconds(5);

/// Newest confidence up to `stamp`, null before the first one.
const LocalizationTrust* trust_at(const std::vector<LocalizationTrust>& trusts, Time stamp) {
  const auto after = std::upper_bound(trusts.begin(), trusts.end(), stamp,
                                      [](Time time, const LocalizationTrust& trust) { return time < trust.stamp; });
  return after == trusts.begin() ? nullptr : &*std::prev(after);
}

}  // namespace

LocalizationScore localization_score(const std::vector<MatchedPose>& matched, const std::vector<LocalizationTrust>& trusts) {
  LocalizationScore score;
  for (std::size_t i = 0; i < trusts.size(); ++i) {
    score.min_trust = std::min(score.min_trust, trusts[i].trust);
    if (trusts[i].trust < kDoubted && !score.doubted_s) score.doubted_s = to_seconds(trusts[i].stamp);
    if (trusts[i].is_lost && i + 1 < trusts.size()) score.lost_s += to_seconds(trusts[i + 1].stamp - trusts[i].stamp);
  }
  for (const MatchedPose& pose : matched) {
    const LocalizationTrust* trust = trust_at(trusts, pose.stamp);
    if (trust == nullptr || trust->is_lost) continue;
    score.max_error_m = std::max(score.max_error_m, pose.position_error_m());
    if (pose.position_error_m() > kStrayed_m && !score.strayed_s) score.strayed_s = to_seconds(pose.stamp);
  }
  return score;
}

RelocalizationScore relocalization_score(Time kidnapped, const std::vector<MatchedPose>& matched,
                                         const std::vector<LocalizationTrust>& trusts) {
  RelocalizationScore score{.at_s = to_seconds(kidnapped), .said_lost_s = {}, .relocalized_s = {}};
  for (const LocalizationTrust& trust : trusts) {
    if (trust.stamp < kidnapped || !trust.is_lost) continue;
    score.said_lost_s = to_seconds(trust.stamp - kidnapped);
    break;
  }
  constexpr Time kNever = Time::max();
  Time good_since = kNever;
  bool is_first = true;
  for (const MatchedPose& pose : matched) {
    if (pose.stamp < kidnapped) continue;
    if (std::exchange(is_first, false)) score.moved_m = pose.position_error_m();
    const LocalizationTrust* trust = trust_at(trusts, pose.stamp);
    const bool is_good = pose.position_error_m() < kStrayed_m && trust != nullptr && !trust->is_lost;
    if (!is_good) good_since = kNever;
    if (is_good) good_since = std::min(good_since, pose.stamp);
    if (good_since != kNever && pose.stamp - good_since >= kKeeps) break;
  }
  if (good_since != kNever) score.relocalized_s = to_seconds(good_since - kidnapped);
  return score;
}

}  // namespace patrol::score
