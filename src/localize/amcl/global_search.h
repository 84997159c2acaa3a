#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <vector>

#include "core/grid.h"
#include "core/messages.h"
#include "core/random.h"
#include "core/settings.h"
#include "localize/amcl/likelihood_field.h"
#include "localize/amcl/range_likelihood.h"

namespace patrol::localize {

struct GlobalSearchSettings {
  double step_m = 0.4;             ///< of the coarse grid of positions
  double step_rad = 0.105;         ///< and of headings: 6 degrees
  int max_beams = 60;
  int coarse_samples = 1000;       ///< cells of the coarse grid that are looked at closely
  double min_clearance_m = 0.2;    ///< the body stands no nearer to a wall

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("step_m", self.step_m, between(0.05, 5.0));
    visit("step_rad", self.step_rad, between(0.01, 1.6));
    visit("max_beams", self.max_beams, between(10, 10000));
    visit("coarse_samples", self.coarse_samples, between(1, 1000000));
    visit("min_clearance_m", self.min_clearance_m, between(0.0, 5.0));
  }
};

/// Finds where on the whole map a scan, and the UWB ranges if there are any, may have been taken.
///
/// Two levels, as in correlative matching (Olson, ICRA 2009): every free place and heading of a coarse grid on a blurred field;
/// then, sampled in proportion to that likelihood, fine grids on the filter's own field. Sampling, not the best so many:
/// in a tunnel that looks alike everywhere all places stay candidates, and the filter stays honestly undecided.
class GlobalSearch {
 public:
  GlobalSearch(const GlobalSearchSettings& settings, const LikelihoodFieldSettings& field, const OccupancyGrid& map, const LineField& lines);

  struct Candidates {
    std::vector<Pose2> T_map_body;
    std::vector<double> weights;  ///< sum 1
    double half_step_m = 0.0, half_step_rad = 0.0;  ///< each stands for the poses this near
  };
  /// `independent_beams`: a scan says as much as so many beams that err independently. Empty if the map has no free place.
  Candidates find(const LevelScan& scan, const std::vector<AnchoredRange>& ranges, const RangeLikelihoodSettings& range_settings,
                  double independent_beams, double uniform) const;

 private:
  struct Place {
    Eigen::Vector2d p_map;
    double log_ranges;
  };
  std::vector<Place> places_by_range(const std::vector<AnchoredRange>& ranges, const RangeLikelihoodSettings& settings) const;

  GlobalSearchSettings settings_;
  LikelihoodField coarse_, fine_;
  std::vector<Eigen::Vector2d> free_places_;  ///< in map, m
};

/// `count` poses drawn from candidates, each moved at random within its step.
std::vector<Pose2> draw_poses(const GlobalSearch::Candidates& candidates, std::size_t count, const RandomStream& noise, std::uint64_t tick);

}  // namespace patrol::localize
