#pragma once

#include "core/settings.h"

namespace patrol::inspect {

/// Laying a cloud of points on another, coarse to fine.
struct RegistrationSettings {
  double first_distance_m = 1.0;  ///< pairs may be that far apart at first, half as far each time that the steps have become small
  double last_distance_m = 0.05;  ///< and that far at last
  int sample = 6000;              ///< points of the new scan, in equal parts from all directions that surfaces face
  int max_iterations = 80;
  double step_tol_m = 2e-4;       ///< a smaller step, seen 10 m away, has converged

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("first_distance_m", self.first_distance_m, between(0.01, 10.0));
    visit("last_distance_m", self.last_distance_m, between(0.005, 1.0));
    visit("sample", self.sample, between(100, 1000000));
    visit("max_iterations", self.max_iterations, between(1, 10000));
    visit("step_tol_m", self.step_tol_m, between(1e-6, 0.1));
  }
};

/// What the comparison of two scans takes for granted, and from when on it matters.
struct LiningSettings {
  double near_m = 1.5;                ///< nearer to the scanner is the robot itself
  double spacing_m = 0.08;            ///< points are averaged over that
  double reach_m = 16.0;              ///< rings are compared that far along the tunnel, to both sides of the scanner
  double sector_deg = 10.0;           ///< of the clock; a cell is a ring's part in one sector
  double lowest_clock_deg = 110.0;    ///< middle of the lowest sector on either side: below it is the ground
  double joint_margin_m = 0.1;        ///< left out on both sides of a joint between rings: localisation and registration err along the tunnel
  double band_m = 0.06;               ///< the lining lies that near the design, and moves by less
  int min_points = 12;                ///< thinned ones; a cell with fewer in either scan is not reported
  double surface_std_m = 0.0001;      ///< of a cell, from what neither averaging nor scatter shows: facets, texture
  double fixture_std_m = 0.003;       ///< of half a metre of any surface other than the lining's
  double range_offset_std_m = 0.001;  ///< of a scanner from scan to scan, all ranges alike; it is estimated with the pose
  double guess_std_m = 0.3;           ///< of the robot's own estimate
  double guess_std_deg = 2.0;
  double min_share = 0.5;             ///< of the points that have a partner in the reference, fewer is no registration
  double max_correction_m = 0.8;      ///< of the robot's own estimate: it is not that far off, another place is
  double max_along_std_m = 0.005;     ///< of the registered position along the tunnel; a greater one says that nothing holds it there
  double min_grip_share = 0.4;        ///< of the surfaces that face along the tunnel, which alone tell one place from another
  double notice_mm = 2.0;
  double warning_mm = 5.0;
  double alarm_mm = 10.0;
  double significance = 4.5;          ///< standard deviations that a finding is away from nothing
  RegistrationSettings registration;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("near_m", self.near_m, between(0.0, 10.0));
    visit("spacing_m", self.spacing_m, between(0.01, 0.5));
    visit("reach_m", self.reach_m, between(1.0, 100.0));
    visit("sector_deg", self.sector_deg, between(2.0, 45.0));
    visit("lowest_clock_deg", self.lowest_clock_deg, between(0.0, 170.0));
    visit("joint_margin_m", self.joint_margin_m, between(0.0, 1.0));
    visit("band_m", self.band_m, between(0.005, 1.0));
    visit("min_points", self.min_points, between(5, 100000));
    visit("surface_std_m", self.surface_std_m, between(0.0, 0.01));
    visit("fixture_std_m", self.fixture_std_m, between(1e-5, 0.1));
    visit("range_offset_std_m", self.range_offset_std_m, between(1e-6, 0.1));
    visit("guess_std_m", self.guess_std_m, between(1e-3, 10.0));
    visit("guess_std_deg", self.guess_std_deg, between(0.01, 90.0));
    visit("min_share", self.min_share, between(0.0, 1.0));
    visit("max_correction_m", self.max_correction_m, between(0.0, 100.0));
    visit("max_along_std_m", self.max_along_std_m, between(0.0, 10.0));
    visit("min_grip_share", self.min_grip_share, between(0.0, 1.0));
    visit("notice_mm", self.notice_mm, between(0.0, 1000.0));
    visit("warning_mm", self.warning_mm, between(0.0, 1000.0));
    visit("alarm_mm", self.alarm_mm, between(0.0, 1000.0));
    visit("significance", self.significance, between(0.0, 100.0));
    visit("registration", self.registration);
  }
};

}  // namespace patrol::inspect
