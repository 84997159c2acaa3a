#pragma once

#include "core/settings.h"

namespace patrol::inspect {

/// Settings of the coarse-to-fine registration of two point clouds.
struct RegistrationSettings {
  /// Initial maximum distance of pairs, halved each time the steps have become small.
  double initial_pair_distance_m = 1.0;
  double final_pair_distance_m = 0.05;  ///< final maximum distance of pairs
  int sample = 6000;        ///< number of points of the new scan, balanced over the directions of the surface normals
  int max_iterations = 80;  ///< maximum number of iterations
  double step_tolerance_m = 2e-4;  ///< convergence limit of a step, for points 10 m away

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("initial_pair_distance_m", self.initial_pair_distance_m, between(0.01, 10.0));
    visit("final_pair_distance_m", self.final_pair_distance_m, between(0.005, 1.0));
    visit("sample", self.sample, between(100, 1000000));
    visit("max_iterations", self.max_iterations, between(1, 10000));
    visit("step_tolerance_m", self.step_tolerance_m, between(1e-6, 0.1));
  }
};

/// Assumptions and thresholds of the comparison of two scans.
struct LiningSettings {
  double min_range_m = 1.5;  ///< distance from the scanner below which points are excluded as parts of the robot
  double spacing_m = 0.08;   ///< averaging distance of the points
  double comparison_range_m = 16.0;  ///< comparison range along the tunnel, to both sides of the scanner
  double sector_deg = 10.0;          ///< angular width of a cell; a cell is the part of a ring in one sector
  double lowest_clock_deg = 110.0;   ///< center of the lowest sector on each side; the ground is below
  /// Width that is excluded on both sides of a ring joint, because localization and registration have axial errors.
  double joint_margin_m = 0.1;
  double design_tolerance_m = 0.06;  ///< maximum distance of the lining from the design, including its displacement
  int min_points = 12;  ///< minimum number of downsampled points of a cell in both scans; other cells are not reported
  /// Standard deviation of a cell from errors that neither averaging nor scatter shows: facets, texture.
  double surface_std_m = 0.0001;
  double fixture_std_m = 0.003;  ///< standard deviation of a 0.5 m patch of any surface other than the lining
  /// Standard deviation of the range offset between scans, common to all ranges; estimated with the pose.
  double range_offset_std_m = 0.001;
  /// Standard deviation of the systematic angle errors of a scan, which averaging does not reduce: half of the variance
  /// of the 19" that the scanner's sheet states. 8 m along the tunnel they displace the lining by 0.7 mm in two scans.
  double angle_std_arcsec = 13.4;
  double prior_std_m = 0.3;       ///< standard deviation of the pose estimate of the robot
  double prior_std_deg = 2.0;     ///< standard deviation of the heading estimate of the robot
  double min_inlier_ratio = 0.5;  ///< minimum inlier ratio of the registration
  /// Maximum correction of the pose estimate of the robot; larger ones indicate a registration to another position.
  double max_correction_m = 0.8;
  /// Maximum standard deviation of the registered position along the tunnel; larger ones indicate degeneracy.
  double max_along_std_m = 0.005;
  double min_axial_overlap = 0.4;  ///< minimum axial overlap: agreement of surfaces that face along the tunnel
  double notice_mm = 2.0;          ///< displacement from which a finding is a notice
  double warning_mm = 5.0;         ///< displacement from which a finding is a warning
  double alarm_mm = 10.0;          ///< displacement from which a finding is an alarm
  double significance = 4.5;       ///< minimum ratio of a finding to its standard deviation
  RegistrationSettings registration;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min_range_m", self.min_range_m, between(0.0, 10.0));
    visit("spacing_m", self.spacing_m, between(0.01, 0.5));
    visit("comparison_range_m", self.comparison_range_m, between(1.0, 100.0));
    visit("sector_deg", self.sector_deg, between(2.0, 45.0));
    visit("lowest_clock_deg", self.lowest_clock_deg, between(0.0, 170.0));
    visit("joint_margin_m", self.joint_margin_m, between(0.0, 1.0));
    visit("design_tolerance_m", self.design_tolerance_m, between(0.005, 1.0));
    visit("min_points", self.min_points, between(5, 100000));
    visit("surface_std_m", self.surface_std_m, between(0.0, 0.01));
    visit("fixture_std_m", self.fixture_std_m, between(1e-5, 0.1));
    visit("range_offset_std_m", self.range_offset_std_m, between(1e-6, 0.1));
    visit("angle_std_arcsec", self.angle_std_arcsec, between(0.0, 3600.0));
    visit("prior_std_m", self.prior_std_m, between(1e-3, 10.0));
    visit("prior_std_deg", self.prior_std_deg, between(0.01, 90.0));
    visit("min_inlier_ratio", self.min_inlier_ratio, between(0.0, 1.0));
    visit("max_correction_m", self.max_correction_m, between(0.0, 100.0));
    visit("max_along_std_m", self.max_along_std_m, between(0.0, 10.0));
    visit("min_axial_overlap", self.min_axial_overlap, between(0.0, 1.0));
    visit("notice_mm", self.notice_mm, between(0.0, 1000.0));
    visit("warning_mm", self.warning_mm, between(0.0, 1000.0));
    visit("alarm_mm", self.alarm_mm, between(0.0, 1000.0));
    visit("significance", self.significance, between(0.0, 100.0));
    visit("registration", self.registration);
  }
};

}  // namespace patrol::inspect
