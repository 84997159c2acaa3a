#pragma once

#include <optional>
#include <vector>

#include "core/dock_sighting.h"
#include "core/messages.h"
#include "core/settings.h"

namespace patrol::localize {

struct DockDetectorSettings {
  double search_m = 0.3;        ///< the post is looked for so far from where it is expected, along and across
  double search_rad = 0.2;      ///< and turned by so much
  double range_std_m = 0.025;   ///< of one beam
  double margin_m = 0.15;       ///< the post's ends are free-standing by so much: hits there speak against it
  double min_explained = 0.75;  ///< share of the beams about the post
  double max_rms_m = 0.04;
  int min_beams = 25;           ///< on the post
  double max_range_m = 4.0;     ///< farther away it is not looked for

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("search_m", self.search_m, between(0.02, 1.0));
    visit("search_rad", self.search_rad, between(0.02, 0.8));
    visit("range_std_m", self.range_std_m, between(0.001, 0.2));
    visit("margin_m", self.margin_m, between(0.0, 1.0));
    visit("min_explained", self.min_explained, between(0.1, 1.0));
    visit("max_rms_m", self.max_rms_m, between(0.005, 0.5));
    visit("min_beams", self.min_beams, between(5, 10000));
    visit("max_range_m", self.max_range_m, between(0.5, 50.0));
  }
};

/// Finds the charging post by its outline. For a supposed pose each beam has a range at which it should meet the outline; a
/// beam supports the pose by 1 - (error / w)^2 within w. The pose with the most support is searched coarsely around the expected
/// one, then step by step down to a millimetre: a maximum likelihood with outliers cut off. Because the whole outline is
/// cast and not each hit assigned to its nearest line, the silhouette's edges count as well: even a flat face has a middle.
///
/// Says nothing when the shape is not there: too few beams of those that should meet it do, other hits adjoin its ends (a
/// wall), or one direction stays open.
class DockDetector {
 public:
  /// `profile_m`: the post's outline at the lidar's height as a polyline in the docked body's frame. Throws InputError when
  /// it has fewer than two points.
  DockDetector(const DockDetectorSettings& settings, std::vector<Eigen::Vector2d> profile_m);

  /// `T_level_expected`: where the docked body should be, from where the level body is.
  std::optional<DockSighting> detect(const LevelScan& scan, const Pose2& T_level_expected) const;

 private:
  struct Beam {
    Eigen::Vector2d direction;  ///< in level, unit
    double range_m;             ///< from the lidar
    bool is_hit;
  };
  struct Fit {
    Pose2 T_level_docked;
    double support = 0.0;
  };

  std::vector<Beam> beams_about(const LevelScan& scan, const Pose2& T_level_expected) const;
  std::vector<Beam> hits_near(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m,
                              const Pose2& T_level_expected) const;
  /// From the middle of the expected post to the farthest thing that matters.
  double reach_m() const;
  double support(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m, const Pose2& T_level_docked,
                 double width_m) const;
  /// Distance along a ray to the outline; infinite if it passes by.
  double cast(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction) const;
  Pose2 moved(const Pose2& T_level_docked, int axis, double step_m) const;
  Fit search(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m, const Pose2& T_level_expected) const;
  Fit refine(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m, const Pose2& T_level_docked) const;
  void climb(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m, double width_m, double step_m, Fit& fit) const;
  std::optional<Eigen::Matrix3d> covariance(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m,
                                            const Fit& fit) const;
  bool judge(const std::vector<Beam>& beams, const Eigen::Vector2d& origin_m, DockSighting& sighting) const;

  DockDetectorSettings settings_;
  std::vector<Eigen::Vector2d> profile_m_;
  Eigen::Vector2d middle_m_;  ///< of the outline, in the docked body's frame
  double radius_m_ = 0.0;     ///< about it
};

}  // namespace patrol::localize
