#pragma once

#include <optional>
#include <vector>

#include "core/dock_detection.h"
#include "core/messages.h"
#include "core/settings.h"

namespace patrol::localize {

struct DockDetectorSettings {
  double search_m = 0.3;        ///< search range around the expected position, longitudinal and lateral
  double search_rad = 0.2;      ///< search range around the expected heading
  double range_std_m = 0.025;   ///< standard deviation of the range of one beam
  double end_clearance_m = 0.15;  ///< free space required next to the ends of the post: hits there count against the detection
  double min_inlier_ratio = 0.75;  ///< minimum inlier ratio of the beams around the post
  double max_rms_m = 0.04;
  int min_beams = 25;           ///< minimum number of beams on the post
  double max_range_m = 4.0;     ///< maximum distance of the expected post for a search

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("search_m", self.search_m, between(0.02, 1.0));
    visit("search_rad", self.search_rad, between(0.02, 0.8));
    visit("range_std_m", self.range_std_m, between(0.001, 0.2));
    visit("end_clearance_m", self.end_clearance_m, between(0.0, 1.0));
    visit("min_inlier_ratio", self.min_inlier_ratio, between(0.1, 1.0));
    visit("max_rms_m", self.max_rms_m, between(0.005, 0.5));
    visit("min_beams", self.min_beams, between(5, 10000));
    visit("max_range_m", self.max_range_m, between(0.5, 50.0));
  }
};

/// Detector of the charging post by its outline. For a pose hypothesis, the outline predicts a range for each beam. A
/// beam supports the hypothesis by 1 - (error / w)^2 if the error is below w: a maximum-likelihood estimate with
/// truncated outliers. The pose with maximum support is searched on a coarse grid around the expected pose and then
/// refined to less than a millimeter. Casting the complete outline, instead of assigning hits to their nearest lines,
/// also uses the silhouette edges. Thus even a flat face constrains the lateral position.
///
/// Returns no detection if too few of the predicted beams match, if other hits adjoin the ends (a wall), or if a
/// direction is degenerate.
class DockDetector {
 public:
  /// Creates the detector. `profile_m`: outline of the post at lidar height, a polyline in the frame of the docked
  /// body. Throws InputError if it has fewer than two points.
  DockDetector(const DockDetectorSettings& settings, std::vector<Eigen::Vector2d> profile_m);

  /// Searches the post in a scan. `T_level_expected`: expected docked pose in the present `level` frame.
  std::optional<DockDetection> detect(const LevelScan& scan, const Pose2& T_level_expected) const;

 private:
  struct Beam {
    Eigen::Vector2d direction;  ///< unit vector in level
    double range_m;             ///< range from the lidar
    bool is_hit;
  };
  struct Fit {
    Pose2 T_level_docked;
    double support = 0.0;
  };

  std::vector<Beam> beams_about(const LevelScan& scan, const Pose2& T_level_expected) const;
  std::vector<Beam> hits_near(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m,
                              const Pose2& T_level_expected) const;
  /// Returns the radius around the center of the expected post that contains all relevant beams.
  double max_beam_distance_m() const;
  double support(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m, const Pose2& T_level_docked,
                 double width_m) const;
  /// Returns the distance along a ray to the outline; infinite if the ray misses it.
  double cast(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction) const;
  Pose2 step_pose(const Pose2& T_level_docked, int axis, double step_m) const;
  Fit search(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m, const Pose2& T_level_expected) const;
  Fit refine(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m, const Pose2& T_level_docked) const;
  void climb(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m, double width_m, double step_m, Fit& fit) const;
  std::optional<Eigen::Matrix3d> covariance(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m,
                                            const Fit& fit) const;
  bool accept(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m, DockDetection& detection) const;

  DockDetectorSettings settings_;
  std::vector<Eigen::Vector2d> profile_m_;
  Eigen::Vector2d middle_m_;  ///< center of the outline, in the frame of the docked body
  double radius_m_ = 0.0;     ///< maximum distance of the outline from its center
};

}  // namespace patrol::localize
