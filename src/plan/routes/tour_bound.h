#pragma once

#include "plan/routes/tour_order.h"

namespace patrol::plan {

/// What no order's completion undercuts: travel by the Lagrangian bound of 1-trees (Held, Karp 1970; subgradient ascent as in their 1971 paper, step
/// length by Polyak from `upper_bound`) on the symmetric lesser of both ways, with all service; and each station's earliest end. Infinite if the
/// stations do not hang together. Of rounds it is mostly within 2 % of the best, of ways with free ends within 8 %.
double tour_lower_bound(const TourProblem& problem, double upper_bound, int iterations);

}  // namespace patrol::plan
