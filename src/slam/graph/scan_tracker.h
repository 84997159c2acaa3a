#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/messages.h"
#include "core/settings.h"
#include "slam/graph/branch_and_bound.h"
#include "slam/graph/likelihood_pyramid.h"
#include "slam/graph/odometry_correction.h"
#include "slam/graph/odometry_delay.h"
#include "slam/graph/scan_group.h"
#include "slam/graph/scan_tracker_settings.h"
#include "slam/graph/scans_since_keyframe.h"
#include "slam/graph/tracker_maps.h"
#include "slam/graph/uneven_ground.h"
#include "slam/graph/usual_match.h"
#include "slam/motion_model.h"
#include "slam/scan_matcher.h"

namespace patrol::slam {

struct TrackedScan {
  Pose2 T_local_body;
  /// Information of the scan alone, in `local`; zero: no match.
  Eigen::Matrix3d match_information = Eigen::Matrix3d::Zero();
  /// Covariance of the odometry since the last match, updated with this match; in `local`.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double inlier_ratio = 0.0;
  bool is_keyframe = false;
  ScanGroup scans = {};  ///< scans of a keyframe
  /// Index of the matched submap: 0, 1, ...; a keyframe is part of it, including the last one, after which the next
  /// submap takes over.
  int submap = 0;
  bool is_submap_start = false;  ///< keyframe that begins a new map
};

/// Tracks the robot by matching each scan against a map of the last meters: locally consistent, drifting with distance.
/// Corresponds to local SLAM of [Hess16]. The origin of `local` is the pose of the first scan.
///
/// Scans are matched with the older one of two overlapping maps (tracker_maps.h).
///
/// Odometry is calibrated while tracking (odometry_correction.h), and so is its time offset to the scans
/// (odometry_delay.h).
///
/// Robust against failures of wheel odometry (slip, frozen, constant or reversed readings). Alternative start poses are
/// the previous motion, no motion, the reversed motion, and, if the odometry prediction does not match as usual, the
/// best pose of a search over all possible motions. An alternative replaces the odometry prediction if its gain in scan
/// likelihood exceeds its loss under the Student's t prior of odometry. Odometry that contradicts a match has a larger
/// covariance for the next scans. Odometry that does not change at all while the robot moves is not used: the
/// prediction is then the previous motion, with a covariance that contains all possible motions.
///
/// Robust against gaps between scans: if odometry leaves the possible motions of a scan interval, but not those of the
/// gap, only poses around its prediction are matched, and without a match the pose follows odometry.
///
/// Robust against sparse scans, whose few points can match anywhere: one that matches as usual has no alternatives, and
/// otherwise both the alternative and the match of the odometry prediction are continued. Several such tracks exist at
/// a time, and the one with the highest probability of its last scans is the result. Keyframes consist of all scans
/// since the last keyframe, so that the map is dense. So they do with noisy ranges (range_noise.h).
///
/// Robust against moving objects: a match that contradicts odometry needs the majority of the sectors of bearings that
/// distinguish the two poses. Sectors of a rejected match are left out.
///
/// Robust against ground in the scans (uneven_ground.h): near slopes, a match that strongly contradicts odometry is
/// used only if as many points match as usual. Otherwise the pose follows odometry.
class ScanTracker {
 public:
  explicit ScanTracker(const ScanTrackerSettings& settings);

  /// `T_odom_stamp`: odometry at the stamp of the scan.
  TrackedScan update(const LevelScan& scan, const Pose2& T_odom_stamp);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(maps_, stamp_, T_odom_last_, T_local_keyframe_, tracks_, last_step_s_, T_local_constant_,
            is_odometry_constant_, delay_, correction_, usual_, uneven_ground_, scans_since_keyframe_, pyramid_);
  }

 private:
  struct Hypothesis {
    Pose2 T_local_body;
    std::optional<MatchResult> match = {};
    double log_prior = 0.0;
    std::vector<double> log_likelihoods = {};  ///< [point]; empty: not computed
  };

  /// Reference pose from which odometry is integrated: the last match.
  struct Fix {
    Time stamp{};
    Pose2 T_local_body, T_odom_body;
  };

  /// Pose of the last scan as one of several possibilities.
  struct Track {
    Pose2 T_local_last;
    Pose2 T_last_now;                      ///< last motion between two scans
    Fix matched;                           ///< last matched scan
    double odometry_variance_scale = 1.0;  ///< scale factor of the odometry variance
    double score = 0.0;                    ///< log of the probability, with decaying weights of earlier scans
  };

  /// Scan to be tracked, and its step from the previous scan.
  struct Step {
    Time stamp{};
    double seconds = 0.0;
    Pose2 T_odom_body;
    Pose2 T_last_odom;                  ///< step by calibrated odometry
    bool is_sparse = false;             ///< the scan has few returns
    bool is_odometry_constant = false;  ///< odometry is constant although the robot moves
    bool is_gap = false;                ///< odometry shows that the robot left the search over possible motions
  };

  /// Continuation of a track.
  struct Branch {
    std::size_t track = 0;
    PoseGaussian prediction;  ///< pose predicted by odometry
    Hypothesis best;
    double score = 0.0;
  };

  /// `is_fixed`: odometry is integrated from this scan on.
  Track continued_track(const Branch& branch, const Step& step, bool is_fixed) const;
  PoseGaussian predict(const Track& track, const Step& step) const;
  PoseGaussian predict_without_odometry(const Track& track, const Step& step) const;
  Pose2 motion_as_before(const Track& track, const Step& step) const;
  void update_constant_odometry(const Pose2& T_odom_body, const Pose2& T_local_body);
  std::vector<Branch> continue_tracks(const std::vector<MatchPoint>& points, const Step& step);
  double score(const Track& track, const Branch& branch, const std::vector<MatchPoint>& points) const;
  Hypothesis match_by_alternatives(const Track& track, const Hypothesis& by_odometry,
                                   const std::vector<MatchPoint>& points, const Step& step,
                                   const PoseGaussian& prediction);
  /// Continues a track by a match, or by odometry if the match may be one with ground.
  Branch to_branch(std::size_t track, const Step& step, const Hypothesis& best, const PoseGaussian& prediction) const;
  Hypothesis match_after_gap(const Hypothesis& by_odometry, const std::vector<MatchPoint>& points,
                             const PoseGaussian& prediction);
  SearchWindow possible_motions(const Pose2& T_local_last, double seconds) const;
  bool is_gap(const Step& step) const;
  std::optional<Pose2> search(const SearchWindow& window, const std::vector<MatchPoint>& points);
  static double updated_variance_scale(double scale, const PoseGaussian& prediction, const Hypothesis& best);
  void calibrate_odometry(Time stamp, const Fix& before, const Pose2& T_odom_body, const Hypothesis& best);
  TrackedScan to_tracked_scan(const Hypothesis& best, const PoseGaussian& prediction) const;
  bool is_keyframe_due(const Pose2& T_local_body) const;
  static bool is_determined_by_scan(const Hypothesis& a, const Hypothesis& b);
  double tempering(std::size_t num_points) const;
  bool is_better(const Hypothesis& a, const Hypothesis& b, const std::vector<MatchPoint>& points) const;
  Hypothesis without_moving_objects(const Hypothesis& best, const std::vector<MatchPoint>& points,
                                    const PoseGaussian& prediction) const;
  Hypothesis match_by_odometry(const std::vector<MatchPoint>& points, const PoseGaussian& prediction) const;
  /// Match from an alternative start pose, without log likelihoods; empty if it is the best match already found.
  Hypothesis match_from(const Pose2& T_local_start, const std::vector<MatchPoint>& points,
                        const PoseGaussian& prediction, const Hypothesis& best) const;
  static Hypothesis to_hypothesis(const std::optional<MatchResult>& match, const PoseGaussian& prediction);
  /// Computes the log likelihoods of the points.
  void evaluate(Hypothesis& hypothesis, const std::vector<MatchPoint>& points) const;
  void integrate(TrackedScan& tracked);

  ScanTrackerSettings settings_;
  TrackerMaps maps_;
  std::optional<Time> stamp_;
  Pose2 T_odom_last_, T_local_keyframe_;
  std::vector<Track> tracks_ = std::vector<Track>(1);  ///< the one with the highest score first
  double last_step_s_ = 0.0;
  Pose2 T_local_constant_;  ///< tracked pose at the last change of odometry
  bool is_odometry_constant_ = false;
  OdometryDelay delay_;
  OdometryCorrection correction_;
  UsualMatch usual_;
  UnevenGround uneven_ground_;
  ScansSinceKeyframe scans_since_keyframe_;
  std::optional<LikelihoodPyramid> pyramid_;  ///< pyramid of the older map; none: not needed since the map has changed
};

}  // namespace patrol::slam
