#pragma once

#include "core/settings.h"

namespace patrol::slam {

struct SubmapConstraintSettings {
  double min_margin = 0.2;          ///< minimum classifier margin (-1 ... 1) of neighbors
  double max_fine_shift_m = 0.5;    ///< largest displacement of a submap from its coarse pose by an accepted fine match
  double max_fine_shift_rad = 0.1;  ///< largest rotation of a submap from its coarse pose by an accepted fine match
  double min_overlap_consistency = 0.6;  ///< minimum inlier ratio (mutual_overlap_consistency)
  double max_window_m = 15.0;   ///< maximum half width of the search for a second-best match around the prediction
  double max_window_rad = 0.8;  ///< maximum half width in yaw of the search for a second-best match
  double max_second_best_ratio =
      0.9;  ///< largest score of a distinct pose, relative to that of the match, of an accepted match
  double min_second_best_distance_m = 0.8;  ///< distance from the match at which another pose is distinct
  double min_second_best_angle_rad = 0.35;  ///< rotation from the match at which another pose is distinct

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min_margin", self.min_margin, between(-1.0, 1.0));
    visit("max_fine_shift_m", self.max_fine_shift_m, at_least(0.0));
    visit("max_fine_shift_rad", self.max_fine_shift_rad, at_least(0.0));
    visit("min_overlap_consistency", self.min_overlap_consistency, between(0.0, 1.0));
    visit("max_window_m", self.max_window_m, between(0.1, 100.0));
    visit("max_window_rad", self.max_window_rad, between(0.01, 3.2));
    visit("max_second_best_ratio", self.max_second_best_ratio, between(0.0, 1.0));
    visit("min_second_best_distance_m", self.min_second_best_distance_m, at_least(0.0));
    visit("min_second_best_angle_rad", self.min_second_best_angle_rad, at_least(0.0));
  }
};

}  // namespace patrol::slam
