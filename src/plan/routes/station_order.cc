#include "plan/routes/station_order.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include <fmt/format.h>

#include "core/error.h"
#include "core/random.h"
#include "plan/routes/held_karp_bound.h"

namespace patrol::plan {
namespace {

constexpr double kNoOrder = std::numeric_limits<double>::infinity();
constexpr double kRounding = 1e-9;

void check(const TourProblem& problem) {
  const std::size_t count = problem.travel.size();
  const auto refuse = [](const std::string& what) { throw InputError("tour: " + what); };
  if (count == 0) refuse("no stations: must be at least 1");
  for (std::size_t i = 0; i < count; ++i) {
    if (problem.travel[i].size() != count)
      refuse(fmt::format("row {} of travel has {} values: must be {}", i, problem.travel[i].size(), count));
    for (std::size_t j = 0; j < count; ++j) {
      if (!(problem.travel[i][j] >= 0.0))
        refuse(fmt::format("travel from {} to {} is {}: must be at least 0", i, j, problem.travel[i][j]));
    }
  }
  if (!problem.stations.empty() && problem.stations.size() != count)
    refuse(fmt::format("{} station descriptions: must be {}", problem.stations.size(), count));
  for (std::size_t i = 0; i < problem.stations.size(); ++i) {
    const TourProblem::Station& station = problem.stations[i];
    if (!(station.service >= 0.0) || !(station.earliest >= 0.0) || !std::isfinite(station.service + station.earliest) ||
        !(station.latest >= station.earliest)) {
      refuse(fmt::format("station {} has service {} and window [{}, {}]: must be at least 0 and in order", i,
                         station.service, station.earliest, station.latest));
    }
  }
  for (const auto& end : {problem.start, problem.end}) {
    if (end && *end >= count) refuse(fmt::format("unknown station {}: must be in [0, {}]", *end, count - 1));
  }
}

/// Problem with defaults filled in.
class Tour {
 public:
  explicit Tour(const TourProblem& problem) : problem_(problem), stations_(problem.stations) {
    stations_.resize(problem.travel.size());
  }

  std::size_t size() const { return stations_.size(); }
  bool is_closed_tour() const { return problem_.start && problem_.start == problem_.end; }
  bool is_start(std::size_t i) const { return problem_.start == i; }
  bool is_end(std::size_t i) const { return problem_.end == i && !is_closed_tour(); }
  bool is_fixed(std::size_t i) const { return is_start(i) || is_end(i); }
  double travel(std::size_t from, std::size_t to) const { return problem_.travel[from][to]; }
  int priority(std::size_t i) const { return stations_[i].priority; }
  /// Departure time from a station that is reached at `reached`.
  double departure(std::size_t i, double reached) const {
    return std::max(reached, stations_[i].earliest) + stations_[i].service;
  }
  double lateness(std::size_t i, double reached) const {
    return std::max(0.0, reached - stations_[i].latest - kRounding);
  }

  /// Impossible legs, priority inversions, lateness, completion, compared in this order; lower is better.
  using Score = std::tuple<int, int, double, double>;
  Score score(const std::vector<std::size_t>& order) const {
    int impossible = 0, inverted = 0;
    double now = departure(order[0], 0.0), late = lateness(order[0], 0.0);
    const auto go = [&](std::size_t from, std::size_t to) {
      if (std::isinf(travel(from, to))) ++impossible;
      else now += travel(from, to);
    };
    int last = std::numeric_limits<int>::min();
    for (std::size_t k = 0; k < order.size(); ++k) {
      if (k > 0) {
        go(order[k - 1], order[k]);
        late += lateness(order[k], now);
        now = departure(order[k], now);
      }
      if (is_fixed(order[k])) continue;
      if (priority(order[k]) < last) ++inverted;
      last = std::max(last, priority(order[k]));
    }
    if (is_closed_tour() && order.size() > 1) go(order.back(), order.front());
    return {impossible, inverted, late, now};
  }

 private:
  const TourProblem& problem_;
  std::vector<TourProblem::Station> stations_;
};

/// Set of stations: bit i is station i.
using StationSet = std::size_t;

StationSet set_of(std::size_t station) { return StationSet{1} << station; }

/// Returns the stations that must precede each station, by priorities and fixed ends.
std::vector<StationSet> stations_before(const Tour& tour) {
  std::vector<StationSet> before(tour.size(), 0);
  for (std::size_t i = 0; i < tour.size(); ++i) {
    for (std::size_t j = 0; j < tour.size(); ++j) {
      const bool by_priority = !tour.is_fixed(i) && !tour.is_fixed(j) && tour.priority(j) < tour.priority(i);
      if (i != j && (by_priority || tour.is_end(i) || tour.is_start(j))) before[i] |= set_of(j);
    }
  }
  return before;
}

/// Dynamic program over sets of stations [HeldKarp62]: earliest departure from each station after all of a set, with
/// every window met.
class OrderTable {
 public:
  explicit OrderTable(const Tour& tour)
      : tour_(tour),
        size_(tour.size()),
        all_(set_of(size_) - 1),
        departure_((all_ + 1) * size_, kNoOrder),
        previous_((all_ + 1) * size_, 0) {
    const std::vector<StationSet> before = stations_before(tour);
    for (std::size_t i = 0; i < size_; ++i) {
      if (before[i] == 0 && tour.lateness(i, 0.0) == 0.0) departure_[index(set_of(i), i)] = tour.departure(i, 0.0);
    }
    for (StationSet set = 1; set < all_; ++set) {
      for (std::size_t last = 0; last < size_; ++last) extend(set, last, before);
    }
  }

  /// Returns the order with the minimum completion; empty if there is none.
  std::vector<std::size_t> best_order() const {
    std::vector<std::size_t> order;
    std::size_t last = last_of_best();
    for (StationSet set = all_; last < size_ && set != 0;) {
      order.push_back(last);
      const std::size_t previous = previous_[index(set, last)];
      set &= ~set_of(last);
      last = previous;
    }
    std::reverse(order.begin(), order.end());
    return order;
  }

 private:
  std::size_t index(StationSet set, std::size_t last) const { return set * size_ + last; }

  /// Extends the best order of a set that ends at `last` by each other station.
  void extend(StationSet set, std::size_t last, const std::vector<StationSet>& before) {
    const double left = departure_[index(set, last)];
    if (std::isinf(left)) return;
    for (std::size_t next = 0; next < size_; ++next) {
      if ((set & set_of(next)) != 0 || (before[next] & ~set) != 0) continue;
      const double reached = left + tour_.travel(last, next);
      if (std::isinf(reached) || tour_.lateness(next, reached) > 0.0) continue;
      const std::size_t there = index(set | set_of(next), next);
      if (tour_.departure(next, reached) < departure_[there])
        departure_[there] = tour_.departure(next, reached), previous_[there] = static_cast<std::uint8_t>(last);
    }
  }

  /// Returns the last station of the best order of all stations; their number if there is none.
  std::size_t last_of_best() const {
    std::size_t best = size_;
    double soonest = kNoOrder;
    for (std::size_t i = 0; i < size_; ++i) {
      // A closed tour begins at the only station that no station may precede.
      double done = departure_[index(all_, i)];
      for (std::size_t start = 0; start < size_ && size_ > 1; ++start) {
        if (tour_.is_closed_tour() && tour_.is_start(start)) done += tour_.travel(i, start);
      }
      if (done < soonest) soonest = done, best = i;
    }
    return best;
  }

  const Tour& tour_;
  std::size_t size_;
  StationSet all_;
  std::vector<double> departure_;       ///< [index(set, last)]
  std::vector<std::uint8_t> previous_;  ///< [index(set, last)]: station before the last one
};

/// Order with the minimum completion that meets every window; empty if there is none.
std::vector<std::size_t> exact_order(const Tour& tour) { return OrderTable(tour).best_order(); }

/// Or-opt and 2-opt until neither improves: segments of one to three stations are moved, or any segment is reversed.
class LocalSearch {
 public:
  LocalSearch(const Tour& tour, std::vector<std::size_t> order)
      : tour_(tour), order_(std::move(order)), score_(tour.score(order_)) {}

  void run() {
    while (improve()) {}
  }
  const std::vector<std::size_t>& order() const { return order_; }
  const Tour::Score& score() const { return score_; }

 private:
  bool improve() {
    bool is_better = false;
    const std::size_t first = tour_.is_start(order_.front()) ? 1 : 0;
    const std::size_t end = order_.size() - (tour_.is_end(order_.back()) ? 1 : 0);
    for (std::size_t from = first; from < end; ++from) {
      for (std::size_t to = from + 2; to <= end; ++to) {
        is_better |= attempt([&](std::vector<std::size_t>& order) { std::reverse(at(order, from), at(order, to)); });
      }
      for (std::size_t length = 1; length <= 3 && from + length <= end; ++length) {
        for (std::size_t to = first; to < from; ++to) {
          is_better |= attempt([&](std::vector<std::size_t>& order) {
            std::rotate(at(order, to), at(order, from), at(order, from + length));
          });
        }
        for (std::size_t to = from + length + 1; to <= end; ++to) {
          is_better |= attempt([&](std::vector<std::size_t>& order) {
            std::rotate(at(order, from), at(order, from + length), at(order, to));
          });
        }
      }
    }
    return is_better;
  }

  static std::vector<std::size_t>::iterator at(std::vector<std::size_t>& order, std::size_t i) {
    return order.begin() + static_cast<std::ptrdiff_t>(i);
  }

  template <typename Change>
  bool attempt(Change change) {
    candidate_ = order_;
    change(candidate_);
    const Tour::Score score = tour_.score(candidate_);
    const auto& [impossible, inverted, late, completion] = score;
    const auto& [impossible_now, inverted_now, late_now, completion_now] = score_;
    // The improvement must exceed rounding, otherwise the search might cycle.
    if (!(std::tuple(impossible, inverted, late + kRounding, 0.0) <
          std::tuple(impossible_now, inverted_now, late_now, 0.0)) &&
        !(std::tuple(impossible, inverted) == std::tuple(impossible_now, inverted_now) && late <= late_now &&
          completion < completion_now * (1.0 - kRounding))) {
      return false;
    }
    order_.swap(candidate_);
    score_ = score;
    return true;
  }

  const Tour& tour_;
  std::vector<std::size_t> order_, candidate_;
  Tour::Score score_;
};

/// Random order within each priority; the fixed ends keep their positions.
std::vector<std::size_t> random_order(const Tour& tour, RandomSequence random) {
  std::vector<std::size_t> order(tour.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.index(i)]);
  const auto rank = [&](std::size_t i) {
    return std::tuple(!tour.is_start(i), tour.is_end(i), tour.is_fixed(i) ? 0 : tour.priority(i));
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
  return order;
}

/// Nearest-neighbor order from the first station of `order`, within the lowest remaining priority.
std::vector<std::size_t> nearest_order(const Tour& tour, std::vector<std::size_t> order) {
  const std::size_t end = order.size() - (tour.is_end(order.back()) ? 1 : 0);
  for (std::size_t k = 1; k < end; ++k) {
    const auto rank = [&](std::size_t i) { return std::tuple(tour.priority(i), tour.travel(order[k - 1], i)); };
    const auto left = order.begin() + static_cast<std::ptrdiff_t>(k);
    std::iter_swap(left, std::min_element(left, order.begin() + static_cast<std::ptrdiff_t>(end),
                                          [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); }));
  }
  return order;
}

std::vector<std::size_t> searched_order(const Tour& tour, int restarts, std::uint64_t seed) {
  const RandomStream stream(seed, "plan/routes/tour");
  std::optional<LocalSearch> best;
  for (int restart = 0; restart < restarts; ++restart) {
    const std::vector<std::size_t> sampled =
        random_order(tour, RandomSequence(stream, static_cast<std::uint64_t>(restart)));
    LocalSearch search(tour, restart % 2 == 0 ? nearest_order(tour, sampled) : sampled);
    search.run();
    if (!best || search.score() < best->score()) best.emplace(search);
  }
  return best->order();
}

}  // namespace

TourOrder solve_station_order(const TourProblem& problem, const TourOrderSettings& settings, std::uint64_t seed) {
  validate(settings, "tour");
  check(problem);
  const Tour tour(problem);
  TourOrder result;
  if (tour.size() <= static_cast<std::size_t>(settings.exact_stations)) result.stations = exact_order(tour);
  result.is_exact = !result.stations.empty();
  if (!result.is_exact) result.stations = searched_order(tour, settings.restarts, seed);

  const auto [impossible, inverted, late, completion] = tour.score(result.stations);
  result.is_found = impossible == 0 && inverted == 0;
  result.lateness = late;
  result.completion = completion;
  for (std::size_t k = 1; k < result.stations.size(); ++k)
    result.travel += tour.travel(result.stations[k - 1], result.stations[k]);
  if (tour.is_closed_tour() && tour.size() > 1)
    result.travel += tour.travel(result.stations.back(), result.stations.front());
  result.lower_bound = result.is_exact ? completion : held_karp_bound(problem, completion, settings.bound_iterations);
  return result;
}

}  // namespace patrol::plan
