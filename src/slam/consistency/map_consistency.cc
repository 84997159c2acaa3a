#include "slam/consistency/map_consistency.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "slam/graph/branch_and_bound.h"
#include "slam/graph/connections.h"
#include "slam/surface_overlap.h"

namespace patrol::slam {
namespace {

constexpr double kKeptDistance_m = 0.1, kKeptAngleRad = 0.1;
constexpr double kSegment_m = 5.0;
constexpr double kMaxDistance_m = 10.0;  ///< maximum distance between the centers of compared segments
constexpr double kResolution_m = 0.1, kMaxExtent_m = 4000.0, kMaxFreeRange_m = 15.0;
constexpr int kTracedBeams = 60;  ///< number of beams of a scan that are traced through free space
constexpr int kMatchRadius = 2;   ///< cells
constexpr int kMinObserved = 20;  ///< surface points in observed cells of the other segment
constexpr double kMinAgreement = 0.8;
constexpr int kSearchPoints = 300;
constexpr double kSearch_m = 2.0, kSearchRad = 0.2, kMinScore = 0.1;
/// A match elsewhere is a disagreement if its score is better by this, and it is this far away; a rotation counts as
/// the displacement at 3 m.
constexpr double kMinGain = 0.2, kMinOffset_m = 0.3, kLever_m = 3.0;
constexpr std::size_t kCachedSegments = 64;
constexpr int kMinReturns = 3;
constexpr double kMinMatchScore = 0.3;
constexpr double kMaxUnmatchedRatio = 0.2, kMaxWithoutReturnsRatio = 0.2;
/// Length of the path without a matched scan above which it is interrupted.
constexpr double kMaxUntracked_m = 2.0;

/// Kept scans of a segment of the path.
struct Segment {
  Submap range;
  Eigen::Vector2d center_map;
};

/// Parts of the path after interruptions, by the kept scan that begins each.
using PartStarts = std::map<std::size_t, UnconnectedPart>;

/// Segments of the path through `T_map_kept`, whose indices in ranges begin at `first_index`. One begins at each start.
std::vector<Segment> divide(const std::vector<Pose2>& T_map_kept, int first_index, const PartStarts& starts = {}) {
  std::vector<Segment> segments;
  double length_m = 0.0;
  for (std::size_t i = 0; i < T_map_kept.size(); ++i) {
    const int k = first_index + static_cast<int>(i);
    if (i > 0) length_m += (T_map_kept[i].position() - T_map_kept[i - 1].position()).norm();
    if (segments.empty() || length_m > kSegment_m || starts.contains(i)) {
      segments.push_back({.range = {.first = k, .last = k}, .center_map = T_map_kept[i].position()});
      length_m = 0.0;
    }
    Segment& newest = segments.back();
    newest.range.last = k;
    newest.center_map += (T_map_kept[i].position() - newest.center_map) / (k - newest.range.first + 1);
  }
  return segments;
}

/// Returns the mean likelihood of points, as in a search (branch_and_bound.h).
double score_at(const LikelihoodPyramid& map, const std::vector<Eigen::Vector2d>& points, const Pose2& T_map_points) {
  double sum = 0.0;
  for (const Eigen::Vector2d& point : points) {
    const Eigen::Vector2d cell = T_map_points * point / map.resolution_m();
    sum += map.value(0, static_cast<int>(std::floor(cell.x())), static_cast<int>(std::floor(cell.y())));
  }
  return sum / (LikelihoodPyramid::kOnSurface * static_cast<double>(points.size()));
}

/// Result of comparing two segments.
struct Comparison {
  bool is_overlapping = false;
  std::optional<Pose2> better = {};  ///< pose of `b` in `a`, about `p_b`, with which they match
};

/// Compares two rendered segments; `p_b`: center of rotations, in b.
Comparison compare(const RenderedSubmap& a, const RenderedSubmap& b, const Pose2& T_a_b, const Eigen::Vector2d& p_b) {
  const SurfaceOverlap forth = measure_overlap(a.map(), b.surface_points(), T_a_b, kMatchRadius),
                       back = measure_overlap(b.map(), a.surface_points(), T_a_b.inverse(), kMatchRadius);
  if (std::min(forth.num_observed, back.num_observed) < kMinObserved) return {};
  if (std::min(forth.inlier_ratio(), back.inlier_ratio()) >= kMinAgreement) return {.is_overlapping = true};
  std::vector<Eigen::Vector2d> points = positions_of(b.surface_points(), kSearchPoints);
  for (Eigen::Vector2d& point : points) point -= p_b;
  const Pose2 here = T_a_b * Pose2{p_b.x(), p_b.y(), 0.0};
  const std::optional<SearchResult> found = search_window(
      a.pyramid(), points, {.T_map_center = here, .half_width_m = kSearch_m, .half_angle_rad = kSearchRad}, kMinScore);
  if (!found || found->score < score_at(a.pyramid(), points, here) + kMinGain) return {.is_overlapping = true};
  const double offset_m = (found->T_map_points.position() - here.position()).norm(),
               offset_rad = std::abs(wrap_angle(found->T_map_points.yaw - here.yaw));
  if (std::max(offset_m, kLever_m * offset_rad) < kMinOffset_m) return {.is_overlapping = true};
  return {.is_overlapping = true, .better = here.inverse() * found->T_map_points};
}

}  // namespace

bool MapConsistency::has_too_many_unmatched() const { return unmatched_ratio() > kMaxUnmatchedRatio; }

bool MapConsistency::has_too_many_without_returns() const { return without_returns_ratio() > kMaxWithoutReturnsRatio; }

bool MapConsistency::is_consistent() const {
  return num_compared > 0 && disagreements.empty() && unconnected.empty() && unsupported.empty() && frozen.empty() &&
         !has_too_many_unmatched() && !has_too_many_without_returns();
}

void ConsistencyCheck::add(const LevelScan& scan, const SlamUpdate& update) {
  const auto returns =
      std::count_if(scan.beams.begin(), scan.beams.end(), [](const LevelScan::Beam& beam) { return beam.is_hit; });
  const bool is_first = scans_.empty();
  max_beams_ = std::max(max_beams_, scan.beams.size());
  const bool has_returns = returns >= kMinReturns;
  const bool is_unmatched = !is_first && update.match_score && *update.match_score < kMinMatchScore;
  scans_.push_back({.has_returns = has_returns, .is_matched = has_returns && !is_unmatched});
  if (!kept_.empty()) {
    const Pose2 moved = kept_.back().T_local_body.inverse() * update.T_map_body;
    if (moved.position().norm() < kKeptDistance_m && std::abs(moved.yaw) < kKeptAngleRad) return;
  }
  kept_.push_back({.scans = ScanGroup(scan), .T_local_body = update.T_map_body});
  kept_indices_.push_back(scans_.size() - 1);
}

// The pose of an unmatched scan is uncertain: the path is measured from the matched scan before it to the one after it.
std::vector<UnconnectedPart> ConsistencyCheck::find_interruptions(const std::vector<Pose2>& T_map_body) const {
  std::vector<UnconnectedPart> interruptions;
  UnconnectedPart open;
  for (std::size_t i = 1; i < scans_.size(); ++i) {
    const double step_m = (T_map_body[i].position() - T_map_body[i - 1].position()).norm();
    if (scans_[i - 1].is_matched || step_m > kMaxUntracked_m)
      open = {.first_scan = i, .p_map = T_map_body[i].position()};
    open.distance_m += step_m;
    const bool is_end = scans_[i].is_matched || step_m > kMaxUntracked_m;
    if (!is_end || open.distance_m <= kMaxUntracked_m) continue;
    interruptions.push_back(open);
    open.distance_m = 0.0;
  }
  return interruptions;
}

MapConsistency ConsistencyCheck::check(const std::vector<Pose2>& T_map_body,
                                       const std::vector<Keyframe>& earlier) const {
  MapConsistency result;
  bool continues = false;
  UnmatchedSegment without_returns;
  for (std::size_t i = 0; i < scans_.size(); ++i) {
    if (!scans_[i].has_returns) {
      ++result.num_without_returns;
      if (without_returns.num_scans == 0) without_returns = {.first_scan = i, .p_map = T_map_body[i].position()};
      if (++without_returns.num_scans > result.max_without_returns.num_scans)
        result.max_without_returns = without_returns;
      continue;
    }
    without_returns = {};
    ++result.num_scans;
    if (!scans_[i].is_matched) {
      ++result.num_unmatched;
      if (!continues) result.unmatched_segments.push_back({.first_scan = i, .p_map = T_map_body[i].position()});
      ++result.unmatched_segments.back().num_scans;
    }
    continues = !scans_[i].is_matched;
  }
  std::stable_sort(result.unmatched_segments.begin(), result.unmatched_segments.end(),
                   [](const UnmatchedSegment& a, const UnmatchedSegment& b) { return a.num_scans > b.num_scans; });

  std::vector<Keyframe> joined;
  if (!earlier.empty()) {
    joined = earlier;
    joined.insert(joined.end(), kept_.begin(), kept_.end());
  }
  const std::vector<Keyframe>& keyframes = earlier.empty() ? kept_ : joined;
  std::vector<Pose2> T_map_earlier, T_map_kept;
  for (const Keyframe& keyframe : earlier) T_map_earlier.push_back(keyframe.T_local_body);
  for (const std::size_t index : kept_indices_) T_map_kept.push_back(T_map_body[index]);
  std::vector<Segment> segments = divide(T_map_earlier, 0);
  const std::size_t num_earlier = segments.size();
  PartStarts starts;
  for (const UnconnectedPart& part : find_interruptions(T_map_body)) {
    const auto first_kept = std::ranges::lower_bound(kept_indices_, part.first_scan);
    starts.emplace(static_cast<std::size_t>(first_kept - kept_indices_.begin()), part);
  }
  const std::vector<Segment> own = divide(T_map_kept, static_cast<int>(earlier.size()), starts);
  segments.insert(segments.end(), own.begin(), own.end());
  Connections connections(segments.size());
  std::vector<std::pair<std::size_t, UnconnectedPart>> interrupted;  // first segment of a part, and the part
  for (std::size_t s = 1; s < segments.size(); ++s) {
    if (s == num_earlier) continue;
    const std::size_t first = static_cast<std::size_t>(segments[s].range.first);
    const auto start = s > num_earlier ? starts.find(first - earlier.size()) : starts.end();
    if (start != starts.end()) interrupted.emplace_back(s, start->second);
    else connections.connect(s - 1, s);
  }
  result.num_segments = static_cast<int>(own.size());
  std::vector<Pose2> T_map_keyframe = std::move(T_map_earlier);
  T_map_keyframe.insert(T_map_keyframe.end(), T_map_kept.begin(), T_map_kept.end());
  const auto first_scan = [&](std::size_t s) {
    return kept_indices_[static_cast<std::size_t>(segments[s].range.first) - earlier.size()];
  };
  const MapRenderingSettings rendering{
      .resolution_m = kResolution_m,
      .max_extent_m = kMaxExtent_m,
      .integration = {.free_ray_stride = std::max(1, static_cast<int>(max_beams_) / kTracedBeams),
                      .max_free_range_m = kMaxFreeRange_m}};
  SubmapCache cache(kCachedSegments);
  const auto rendered = [&](std::size_t s) {
    return cache.get(static_cast<int>(s), [&] {
      return std::make_shared<const RenderedSubmap>(segments[s].range, keyframes, T_map_keyframe, rendering);
    });
  };
  const auto T_map = [&](std::size_t s) { return T_map_keyframe[static_cast<std::size_t>(segments[s].range.first)]; };
  for (std::size_t b = num_earlier; b < segments.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if ((segments[a].center_map - segments[b].center_map).norm() > kMaxDistance_m) continue;
      const Comparison comparison = compare(*rendered(a), *rendered(b), T_map(a).inverse() * T_map(b),
                                            T_map(b).inverse() * segments[b].center_map);
      result.num_compared += comparison.is_overlapping ? 1 : 0;
      if (comparison.is_overlapping && !comparison.better) connections.connect(a, b);
      if (!comparison.better) continue;
      result.disagreements.push_back({.p_map = 0.5 * (segments[a].center_map + segments[b].center_map),
                                      .first_scan = a < num_earlier ? std::nullopt : std::optional(first_scan(a)),
                                      .second_scan = first_scan(b),
                                      .offset_m = comparison.better->position().norm(),
                                      .offset_rad = comparison.better->yaw});
    }
  }
  for (const auto& [first, part] : interrupted) {
    if (!connections.are_connected(first - 1, first)) result.unconnected.push_back(part);
  }
  std::stable_sort(result.disagreements.begin(), result.disagreements.end(),
                   [](const Disagreement& a, const Disagreement& b) { return a.offset_m > b.offset_m; });
  return result;
}

}  // namespace patrol::slam
