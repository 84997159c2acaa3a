#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/settings.h"

namespace patrol::plan {

struct TourOrderSettings {
  int exact_stations = 13;     ///< up to so many the best order is found, above a good one: exact search takes stations^2 * 2^stations steps
  int restarts = 20;           ///< of the local search
  int bound_iterations = 300;  ///< of the lower bound's ascent

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("exact_stations", self.exact_stations, between(0, 16));
    visit("restarts", self.restarts, between(1, 10000));
    visit("bound_iterations", self.bound_iterations, between(1, 100000));
  }
};

/// What is to be visited. All figures in one unit: metres if there are no windows, else seconds.
struct TourProblem {
  struct Station {
    double service = 0.0;   ///< spent there
    double earliest = 0.0;  ///< service does not begin before this: the robot waits
    double latest = std::numeric_limits<double>::infinity();  ///< nor, if it can be helped, after this
    int priority = 0;       ///< all stations of a lower number come first; the fixed start and end are free of this
  };

  std::vector<std::vector<double>> travel = {};     ///< [from][to]; infinite where there is no way; need not be symmetric
  std::vector<Station> stations = {};               ///< as many, or none: then nothing is asked of any
  std::optional<std::size_t> start = {}, end = {};   ///< free if not given; the same station twice: a round back to the start
};

struct TourOrder {
  bool is_found = false;               ///< an order without impossible legs and against no priority
  std::vector<std::size_t> stations;   ///< in order; a round's start is not repeated at its end
  double completion = 0.0;             ///< when the last service ends, or a round is back, if it sets out at 0: travel, service and waiting
  double travel = 0.0;
  double lateness = 0.0;               ///< summed over the stations: 0 if all windows are kept
  double lower_bound = 0.0;            ///< of the completion, whatever the order
  bool is_exact = false;               ///< the completion is the least possible

  /// By how much of the bound the completion may exceed the least possible.
  double gap() const { return is_exact || lower_bound <= 0.0 ? 0.0 : completion / lower_bound - 1.0; }
};

/// The order in which to visit all stations, least late first, done soonest second. Exact by dynamic programming over sets (Held, Karp 1962; Bellman 1962) for few
/// stations whose windows can be kept; else local search, Or-opt and 2-opt from nearest-neighbour and random orders, beside the bound of Held and
/// Karp's 1-trees (1970, 1971). The same problem and seed give the same order. Throws InputError if the problem is not one.
TourOrder order_tour(const TourProblem& problem, const TourOrderSettings& settings, std::uint64_t seed);

}  // namespace patrol::plan
