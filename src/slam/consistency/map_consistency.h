#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/messages.h"
#include "slam/graph/submap.h"
#include "slam/slam_update.h"

namespace patrol::slam {

/// Two segments of the path that saw the same surfaces in different places of the map.
struct Disagreement {
  Eigen::Vector2d p_map;                  ///< midpoint between the centers of the segments
  std::optional<std::size_t> first_scan;  ///< first scan of the first segment; none: it is of an earlier session
  std::size_t second_scan = 0;            ///< first scan of the second segment
  /// Displacement and rotation of the second segment, about its center, with which its surfaces match the first.
  double offset_m = 0.0, offset_rad = 0.0;
};

/// Consecutive scans that matched no surfaces of the map.
struct UnmatchedSegment {
  std::size_t first_scan = 0, num_scans = 0;
  Eigen::Vector2d p_map = Eigen::Vector2d::Zero();  ///< position of the first scan
};

/// Part of the path that neither scans nor odometry support (unsupported_path.h).
struct UnsupportedPath {
  UnmatchedSegment scans;        ///< scans of the part; a gap between scans: empty, begins after the gap
  double contradiction_m = 0.0;  ///< length of the path that odometry contradicts
  double gap_s = 0.0;            ///< time without scans before the part; 0: the part has scans
};

/// Part of the path that only odometry connects with the part before it.
struct UnconnectedPart {
  std::size_t first_scan = 0;
  Eigen::Vector2d p_map = Eigen::Vector2d::Zero();  ///< position of the first scan
  double distance_m = 0.0;                          ///< length of the interruption along the path
};

/// Agreement of a map with the scans from which it was made, without ground truth.
struct MapConsistency {
  int num_segments = 0;
  int num_compared = 0;                                   ///< pairs of segments that saw the same surfaces
  std::vector<Disagreement> disagreements = {};           ///< largest offset first
  std::size_t num_scans = 0;                              ///< scans with returns
  std::size_t num_unmatched = 0;                          ///< number of scans with returns that matched no surfaces
  std::vector<UnmatchedSegment> unmatched_segments = {};  ///< most scans first
  std::vector<UnconnectedPart> unconnected = {};          ///< earliest first
  std::vector<UnsupportedPath> unsupported = {};          ///< most scans first; ConsistencyCheck leaves it empty
  std::size_t num_without_returns = 0;                    ///< scans with fewer than 3 returns, besides `num_scans`
  UnmatchedSegment max_without_returns = {};              ///< most consecutive scans without returns
  /// Scans of a frozen lidar (frozen_scans.h), most scans first; ConsistencyCheck leaves it empty.
  std::vector<UnmatchedSegment> frozen = {};

  double unmatched_ratio() const {
    return num_scans == 0 ? 0.0 : static_cast<double>(num_unmatched) / static_cast<double>(num_scans);
  }
  /// Fraction of all scans that have no returns.
  double without_returns_ratio() const {
    const std::size_t num_all = num_scans + num_without_returns;
    return num_all == 0 ? 0.0 : static_cast<double>(num_without_returns) / static_cast<double>(num_all);
  }
  bool has_too_many_unmatched() const;        ///< more than a fifth of the scans
  bool has_too_many_without_returns() const;  ///< more than a fifth of the scans
  /// Whether nothing indicates a wrong map: segments could be compared and agree, most scans have returns and matched,
  /// none is of a frozen lidar, scans connect all parts of the path, and scans or odometry support it. A map can be
  /// consistent and wrong, for example if a loop was not closed and its ends do not overlap in the map.
  bool is_consistent() const;
};

/// Collects scans while they are mapped, and compares them with each other at their final poses. The path is divided
/// into segments of 5 m. Two of them disagree if less than 80 % of the surfaces of one lie within 0.2 m of surfaces of
/// the other, where it has observed cells, and if a search within 2 m and 0.2 rad finds a pose at which clearly more
/// of them do. Both are necessary: people and furniture move, and smooth corridors match anywhere along them.
///
/// The path is interrupted where it has no matched scan for more than 2 m, or consecutive scans are further apart. A
/// scan without returns is not matched. Its parts are connected if a segment of each agrees with one of the other.
class ConsistencyCheck {
 public:
  /// Adds the next scan with the result of mapping it.
  void add(const LevelScan& scan, const SlamUpdate& update);
  /// Compares the scans at the poses `T_map_body` [scan] with each other and with the keyframes of earlier sessions,
  /// whose T_local_body is their pose in the map.
  MapConsistency check(const std::vector<Pose2>& T_map_body, const std::vector<Keyframe>& earlier = {}) const;

 private:
  struct MatchedScan {
    bool has_returns, is_matched;
  };
  /// Returns the numbers of scans with and without returns and matches.
  MapConsistency count_scans(const std::vector<Pose2>& T_map_body) const;
  /// Parts after interruptions of the path, whether they are connected or not.
  std::vector<UnconnectedPart> find_interruptions(const std::vector<Pose2>& T_map_body) const;

  std::vector<MatchedScan> scans_;
  std::vector<Keyframe> kept_;             ///< scans at least 0.1 m or 0.1 rad apart
  std::vector<std::size_t> kept_indices_;  ///< [kept scan]: its index
  std::size_t max_beams_ = 0;              ///< maximum number of beams of a scan
};

}  // namespace patrol::slam
