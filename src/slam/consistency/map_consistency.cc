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

/// Segments of the paths of all sessions, those of earlier sessions first.
struct SegmentedPath {
  std::vector<Segment> segments;
  std::size_t num_earlier = 0;                                       ///< number of segments of earlier sessions
  std::vector<std::pair<std::size_t, UnconnectedPart>> interrupted;  ///< first segment of a part, and the part

  /// Returns the connections by the path: of each segment with the one before it in the same part.
  Connections connections_by_path() const {
    Connections connections(segments.size());
    auto next_part = interrupted.begin();
    for (std::size_t s = 1; s < segments.size(); ++s) {
      const bool begins_part = next_part != interrupted.end() && next_part->first == s;
      if (begins_part) ++next_part;
      else if (s != num_earlier) connections.connect(s - 1, s);
    }
    return connections;
  }
};

/// Parts of the path after interruptions, by the kept scan that begins each.
using PartStarts = std::map<std::size_t, UnconnectedPart>;

/// Adds the segments of the path through the poses of keyframes from `begin` to `end`. One begins at each start, which
/// counts from `begin`.
void add_segments(const std::vector<Pose2>& T_map_keyframe, std::size_t begin, std::size_t end,
                  const PartStarts& starts, SegmentedPath& path) {
  double length_m = 0.0;
  for (std::size_t k = begin; k < end; ++k) {
    const Eigen::Vector2d p_map = T_map_keyframe[k].position();
    if (k > begin) length_m += (p_map - T_map_keyframe[k - 1].position()).norm();
    const auto start = starts.find(k - begin);
    if (k == begin || length_m > kSegment_m || start != starts.end()) {
      if (k > begin && start != starts.end()) path.interrupted.emplace_back(path.segments.size(), start->second);
      path.segments.push_back({.range = {.first = static_cast<int>(k)}, .center_map = p_map});
      length_m = 0.0;
    }
    Segment& newest = path.segments.back();
    newest.range.last = static_cast<int>(k);
    newest.center_map += (p_map - newest.center_map) / (newest.range.last - newest.range.first + 1);
  }
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

/// Maps of segments, each rendered when it is first compared.
class SegmentMaps {
 public:
  /// `max_beams`: maximum number of beams of a scan. Keeps references to the vectors.
  SegmentMaps(const std::vector<Segment>& segments, const std::vector<Keyframe>& keyframes,
              const std::vector<Pose2>& T_map_keyframe, int max_beams)
      : segments_(segments),
        keyframes_(keyframes),
        T_map_keyframe_(T_map_keyframe),
        rendering_{.resolution_m = kResolution_m,
                   .max_extent_m = kMaxExtent_m,
                   .integration = {.free_ray_stride = std::max(1, max_beams / kTracedBeams),
                                   .max_free_range_m = kMaxFreeRange_m}} {}

  Comparison compare(std::size_t a, std::size_t b) {
    const Pose2 T_b_map = T_map(b).inverse();
    return slam::compare(*rendered(a), *rendered(b), T_map(a).inverse() * T_map(b), T_b_map * segments_[b].center_map);
  }

 private:
  const Pose2& T_map(std::size_t s) const {
    return T_map_keyframe_[static_cast<std::size_t>(segments_[s].range.first)];
  }
  std::shared_ptr<const RenderedSubmap> rendered(std::size_t s) {
    return cache_.get(static_cast<int>(s), [&] {
      return std::make_shared<const RenderedSubmap>(segments_[s].range, keyframes_, T_map_keyframe_, rendering_);
    });
  }

  const std::vector<Segment>& segments_;
  const std::vector<Keyframe>& keyframes_;
  const std::vector<Pose2>& T_map_keyframe_;
  MapRenderingSettings rendering_;
  SubmapCache cache_{kCachedSegments};
};

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

MapConsistency ConsistencyCheck::count_scans(const std::vector<Pose2>& T_map_body) const {
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
  return result;
}

MapConsistency ConsistencyCheck::check(const std::vector<Pose2>& T_map_body,
                                       const std::vector<Keyframe>& earlier) const {
  MapConsistency result = count_scans(T_map_body);
  std::vector<Keyframe> joined;
  if (!earlier.empty()) {
    joined = earlier;
    joined.insert(joined.end(), kept_.begin(), kept_.end());
  }
  const std::vector<Keyframe>& keyframes = earlier.empty() ? kept_ : joined;
  std::vector<Pose2> T_map_keyframe;
  for (const Keyframe& keyframe : earlier) T_map_keyframe.push_back(keyframe.T_local_body);
  for (const std::size_t index : kept_indices_) T_map_keyframe.push_back(T_map_body[index]);
  PartStarts starts;
  for (const UnconnectedPart& part : find_interruptions(T_map_body)) {
    const auto first_kept = std::ranges::lower_bound(kept_indices_, part.first_scan);
    starts.emplace(static_cast<std::size_t>(first_kept - kept_indices_.begin()), part);
  }
  SegmentedPath path;
  add_segments(T_map_keyframe, 0, earlier.size(), {}, path);
  path.num_earlier = path.segments.size();
  add_segments(T_map_keyframe, earlier.size(), T_map_keyframe.size(), starts, path);
  result.num_segments = static_cast<int>(path.segments.size() - path.num_earlier);

  const std::vector<Segment>& segments = path.segments;
  const auto first_scan = [&](std::size_t s) {
    return kept_indices_[static_cast<std::size_t>(segments[s].range.first) - earlier.size()];
  };
  Connections connections = path.connections_by_path();
  SegmentMaps maps(segments, keyframes, T_map_keyframe, static_cast<int>(max_beams_));
  for (std::size_t b = path.num_earlier; b < segments.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      if ((segments[a].center_map - segments[b].center_map).norm() > kMaxDistance_m) continue;
      const Comparison comparison = maps.compare(a, b);
      result.num_compared += comparison.is_overlapping ? 1 : 0;
      if (comparison.is_overlapping && !comparison.better) connections.connect(a, b);
      if (!comparison.better) continue;
      result.disagreements.push_back({.p_map = 0.5 * (segments[a].center_map + segments[b].center_map),
                                      .first_scan = a < path.num_earlier ? std::nullopt : std::optional(first_scan(a)),
                                      .second_scan = first_scan(b),
                                      .offset_m = comparison.better->position().norm(),
                                      .offset_rad = comparison.better->yaw});
    }
  }
  for (const auto& [first, part] : path.interrupted) {
    if (!connections.are_connected(first - 1, first)) result.unconnected.push_back(part);
  }
  std::stable_sort(result.disagreements.begin(), result.disagreements.end(),
                   [](const Disagreement& a, const Disagreement& b) { return a.offset_m > b.offset_m; });
  return result;
}

}  // namespace patrol::slam
