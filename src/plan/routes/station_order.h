#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/settings.h"

namespace patrol::plan {

struct TourOrderSettings {
  int exact_stations = 13;     ///< maximum for exact search, which takes stations^2 * 2^stations steps
  int restarts = 20;           ///< restarts of the local search
  int bound_iterations = 300;  ///< iterations of the lower bound's ascent

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("exact_stations", self.exact_stations, between(0, 16));
    visit("restarts", self.restarts, between(1, 10000));
    visit("bound_iterations", self.bound_iterations, between(1, 100000));
  }
};

/// Station-order problem: TSP with service times, time windows and priorities. All values have one unit: meters without
/// windows, else seconds.
struct TourProblem {
  struct Station {
    double service = 0.0;                                     ///< service time or equivalent length
    double earliest = 0.0;                                    ///< earliest begin of the service; the robot waits for it
    double latest = std::numeric_limits<double>::infinity();  ///< latest begin of the service; a soft limit
    int priority = 0;  ///< stations of a lower number come first; does not apply to the fixed start and end
  };

  std::vector<std::vector<double>> travel = {};     ///< [from][to]; infinite without a path; need not be symmetric
  std::vector<Station> stations = {};               ///< same number as `travel`, or empty for no requirements
  std::optional<std::size_t> start = {}, end = {};  ///< free if not given; if equal, a closed tour
};

struct TourOrder {
  bool is_found = false;              ///< an order without impossible legs and priority inversions
  std::vector<std::size_t> stations;  ///< in order; the start of a closed tour is not repeated at its end
  double completion = 0.0;            ///< end of the last service or of the closed tour, from a start at 0
  double travel = 0.0;
  double lateness = 0.0;     ///< sum over the stations: 0 if all windows are met
  double lower_bound = 0.0;  ///< lower bound of the completion over all orders
  bool is_exact = false;     ///< whether the completion is proven optimal

  /// Maximum relative excess of the completion over the optimum, from the lower bound.
  double gap() const { return is_exact || lower_bound <= 0.0 ? 0.0 : completion / lower_bound - 1.0; }
};

/// Finds the order in which to visit all stations: minimum lateness first, minimum completion second. For few stations
/// whose windows can be met, exact by dynamic programming on sets [HeldKarp62], [Bellman62]. Otherwise by local search
/// (Or-opt and 2-opt from nearest-neighbor and random orders) with the 1-tree bound [HeldKarp70]. Equal problems and
/// seeds give equal orders. Throws InputError if the problem is invalid.
TourOrder solve_station_order(const TourProblem& problem, const TourOrderSettings& settings, std::uint64_t seed);

}  // namespace patrol::plan
