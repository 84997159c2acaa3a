#pragma once

#include <optional>
#include <vector>

#include "core/dock_detection.h"
#include "core/messages.h"
#include "localize/dock_detector_settings.h"

namespace patrol::localize {

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
  void climb(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m, double width_m, double step_m,
             Fit& fit) const;
  std::optional<Eigen::Matrix3d> covariance(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m,
                                            const Fit& fit) const;
  bool accept(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m, DockDetection& detection) const;

  DockDetectorSettings settings_;
  std::vector<Eigen::Vector2d> profile_m_;
  Eigen::Vector2d middle_m_;  ///< center of the outline, in the frame of the docked body
  double radius_m_ = 0.0;     ///< maximum distance of the outline from its center
};

}  // namespace patrol::localize
