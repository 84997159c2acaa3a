#include "plan/routes/held_karp_bound.h"

#include <algorithm>
#include <cmath>

namespace patrol::plan {
namespace {

constexpr double kNoBound = std::numeric_limits<double>::infinity();

/// 1-tree: a tree over all nodes but node 0, and the two cheapest edges of node 0.
struct OneTree {
  double cost = 0.0;
  std::vector<int> degrees;  ///< [node]
};

using Matrix = std::vector<std::vector<double>>;

/// Symmetric distances of a closed tour whose length is the problem's travel. Node 0 is the start of a closed tour;
/// otherwise a virtual node with distance 0 to every possible first and last station.
Matrix to_closed_tour(const TourProblem& problem) {
  const std::size_t count = problem.travel.size();
  const bool is_closed_tour = problem.start && problem.start == problem.end;
  const std::size_t first = is_closed_tour ? 0 : 1;  // node of station 0
  Matrix cost(count + first, std::vector<double>(count + first, kNoBound));
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < count; ++j)
      cost[i + first][j + first] = std::min(problem.travel[i][j], problem.travel[j][i]);
    if (is_closed_tour) continue;
    const bool may_begin = !problem.start || problem.start == i, may_end = !problem.end || problem.end == i;
    if (may_begin || may_end) cost[0][i + 1] = cost[i + 1][0] = 0.0;
  }
  if (is_closed_tour) {
    std::swap(cost[0], cost[*problem.start]);
    for (std::vector<double>& row : cost) std::swap(row[0], row[*problem.start]);
  }
  return cost;
}

/// Minimum 1-tree (Prim's algorithm); every edge is lengthened by the weights of its nodes.
OneTree min_one_tree(const Matrix& cost, const std::vector<double>& weights) {
  const std::size_t count = cost.size();
  const auto edge = [&](std::size_t i, std::size_t j) { return cost[i][j] + weights[i] + weights[j]; };
  OneTree tree{.cost = 0.0, .degrees = std::vector<int>(count, 0)};
  std::vector<double> nearest(count, kNoBound);
  std::vector<std::size_t> by(count, 1);
  std::vector<char> is_in(count, 0);
  is_in[1] = 1;
  for (std::size_t added = 1;;) {
    for (std::size_t j = 1; j < count; ++j) {
      if (is_in[j] == 0 && edge(added, j) < nearest[j]) nearest[j] = edge(added, j), by[j] = added;
    }
    std::size_t next = 0;
    for (std::size_t j = 1; j < count; ++j) {
      if (is_in[j] == 0 && (next == 0 || nearest[j] < nearest[next])) next = j;
    }
    if (next == 0) break;
    tree.cost += nearest[next];
    ++tree.degrees[next], ++tree.degrees[by[next]];
    is_in[next] = 1;
    added = next;
  }
  std::vector<std::size_t> others;
  for (std::size_t j = 1; j < count; ++j) others.push_back(j);
  std::partial_sort(others.begin(), others.begin() + 2, others.end(),
                    [&](std::size_t a, std::size_t b) { return edge(0, a) < edge(0, b); });
  for (std::size_t k = 0; k < 2; ++k) {
    tree.cost += edge(0, others[k]);
    ++tree.degrees[0], ++tree.degrees[others[k]];
  }
  return tree;
}

double travel_bound(const TourProblem& problem, double upper_bound, int iterations) {
  constexpr int kStallIterations = 10;
  const Matrix cost = to_closed_tour(problem);
  if (cost.size() < 3) {  // no 1-tree: direct travel, for a closed tour both directions
    double travel = 0.0;
    const bool is_closed_tour = problem.start && problem.start == problem.end;
    if (is_closed_tour && problem.travel.size() == 2) travel = problem.travel[0][1] + problem.travel[1][0];
    return travel;
  }
  std::vector<double> weights(cost.size(), 0.0);
  double best = 0.0, step_scale = 2.0;
  for (int iteration = 0, stale = 0; iteration < iterations; ++iteration) {
    const OneTree tree = min_one_tree(cost, weights);
    double bound = tree.cost;
    for (const double weight : weights) bound -= 2.0 * weight;
    if (!std::isfinite(bound)) return kNoBound;
    stale = bound > best + 1e-9 ? 0 : stale + 1;
    best = std::max(best, bound);
    if (stale >= kStallIterations) step_scale *= 0.5, stale = 0;
    double excess = 0.0;
    for (const int degree : tree.degrees) excess += (degree - 2) * (degree - 2);
    if (excess == 0.0) return best;  // the tree is a tour
    const double step = step_scale * std::max(upper_bound - bound, 1e-6 * upper_bound) / excess;
    for (std::size_t i = 0; i < weights.size(); ++i) weights[i] += step * (tree.degrees[i] - 2);
  }
  return best;
}

}  // namespace

double held_karp_bound(const TourProblem& problem, double upper_bound, int iterations) {
  double service = 0.0, last = 0.0;
  for (const TourProblem::Station& station : problem.stations) {
    service += station.service;
    last = std::max(last, station.earliest + station.service);
  }
  return std::max(last, service + travel_bound(problem, upper_bound - service, iterations));
}

}  // namespace patrol::plan
