#pragma once

#include "core/settings.h"

namespace patrol::slam {

struct SubmapMatcherSettings {
  double min_search_score = 0.35;  ///< minimum mean likelihood of the points in the search
  double max_window_m = 15.0;      ///< maximum half width of the search window
  double max_window_rad = 0.8;     ///< maximum half width of the search window in yaw
  int search_points = 300;         ///< number of points of the search
  /// Minimum overlap ratio: points in observed cells of the other map, in both directions.
  double min_overlap_ratio = 0.35;
  /// Minimum inlier ratio: points in the overlap that are on a surface of the other map, in both directions.
  double min_inlier_ratio = 0.75;
  double min_matched_length_m = 8.0;  ///< minimum length of matched surface
  /// Largest score of a distinct pose, relative to the best score, of an accepted match.
  double max_second_best_ratio = 0.9;
  /// Largest inlier ratio of a distinct acceptable pose, relative to that of the match, of an accepted match.
  double max_second_best_inlier_fraction = 0.95;
  double min_second_best_distance_m = 0.8;  ///< distance from the best pose at which another pose is distinct
  double min_second_best_angle_rad = 0.35;  ///< rotation from the best pose at which another pose is distinct

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min_search_score", self.min_search_score, between(0.0, 1.0));
    visit("max_window_m", self.max_window_m, between(0.1, 100.0));
    visit("max_window_rad", self.max_window_rad, between(0.01, 3.2));
    visit("search_points", self.search_points, between(10, 100000));
    visit("min_overlap_ratio", self.min_overlap_ratio, between(0.0, 1.0));
    visit("min_inlier_ratio", self.min_inlier_ratio, between(0.0, 1.0));
    visit("min_matched_length_m", self.min_matched_length_m, at_least(0.0));
    visit("max_second_best_ratio", self.max_second_best_ratio, between(0.0, 1.0));
    visit("max_second_best_inlier_fraction", self.max_second_best_inlier_fraction, between(0.0, 10.0));
    visit("min_second_best_distance_m", self.min_second_best_distance_m, at_least(0.0));
    visit("min_second_best_angle_rad", self.min_second_best_angle_rad, at_least(0.0));
  }
};

}  // namespace patrol::slam
