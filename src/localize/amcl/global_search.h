#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/grid.h"
#include "core/messages.h"
#include "core/random.h"
#include "localize/amcl/global_search_settings.h"
#include "localize/amcl/likelihood_field.h"
#include "localize/amcl/range_likelihood.h"

namespace patrol::localize {

/// Global localization by one scan and, if available, UWB ranges on the whole map.
///
/// Two levels, as in correlative matching [Olson09]: first all free positions and headings of a coarse grid on a
/// blurred field. Then fine grids on the filter's field, at coarse cells sampled in proportion to their likelihood.
/// Sampling is used instead of the N best cells: in a repetitive tunnel all similar positions remain candidates, so the
/// belief stays multimodal.
class GlobalSearch {
 public:
  GlobalSearch(const GlobalSearchSettings& settings, const LikelihoodFieldSettings& field, const OccupancyGrid& map,
               const LineField& lines);

  struct Candidates {
    std::vector<Pose2> T_map_body;
    std::vector<double> weights;                    ///< sum 1
    double half_step_m = 0.0, half_step_rad = 0.0;  ///< half width of the cell that each candidate represents
  };
  /// Searches the map. `effective_beams` is the tempering factor: the effective number of independent beams of a
  /// scan. Returns no candidates if the map has no free cell.
  Candidates find(const LevelScan& scan, const std::vector<AnchoredRange>& ranges,
                  const RangeLikelihoodSettings& range_settings, double effective_beams, double uniform) const;

 private:
  struct CandidatePosition {
    Eigen::Vector2d p_map;
    double log_ranges;
  };
  std::vector<CandidatePosition> filter_positions_by_range(const std::vector<AnchoredRange>& ranges,
                                                           const RangeLikelihoodSettings& settings) const;

  GlobalSearchSettings settings_;
  LikelihoodField coarse_, fine_;
  std::vector<Eigen::Vector2d> free_positions_;  ///< free positions of the coarse grid, in map, m
};

/// Samples `count` poses from the candidates, uniform within the cell of each candidate.
std::vector<Pose2> sample_poses(const GlobalSearch::Candidates& candidates, std::size_t count,
                                const RandomStream& noise, std::uint64_t tick);

}  // namespace patrol::localize
