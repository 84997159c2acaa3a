#pragma once

#include "plan/routes/station_order.h"

namespace patrol::plan {

/// Lower bound of the completion over all station orders. Travel is bounded by the Lagrangian relaxation of 1-trees
/// [HeldKarp70] on the smaller cost of both directions, plus all service times. The subgradient step follows Polyak,
/// from `upper_bound`. The earliest end of each station is a second bound. Infinite if the stations are not connected.
/// Typically within 2 % of the optimum for closed tours, within 8 % for free ends.
double held_karp_bound(const TourProblem& problem, double upper_bound, int iterations);

}  // namespace patrol::plan
