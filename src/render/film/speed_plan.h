#pragma once

#include <vector>

#include "core/time.h"

namespace patrol::render {

/// Interval of run time.
struct TimeSpan {
  Time from{}, to{};
};

/// Playback speeds of a film.
struct SpeedSettings {
  double fast = 8.0;     ///< playback speed: run time / film time
  double slow = 2.0;     ///< playback speed of the slow spans; limited to `fast`
  double ramp_s = 1.25;  ///< film time of a transition between the speeds
};

/// Mapping between film time and run time. The pace (film time / run time) is 1 / fast, and 1 / slow in the slow spans.
/// Before and after each slow span it changes linearly with run time. The film of a run of T seconds with complete
/// ramps has a length of
///   T / fast + sum_i (L_i + r) (1 / slow - 1 / fast)
/// seconds. L_i is the length of slow span i in run time, r = 2 ramp_s / (1 / fast + 1 / slow) the length of a ramp.
class SpeedPlan {
 public:
  /// Merges slow spans whose ramps overlap, and clips spans to the run.
  SpeedPlan(TimeSpan run, std::vector<TimeSpan> slow_spans, const SpeedSettings& settings);

  double length_s() const { return nodes_.back().film_s; }
  /// Run time at `film_s`, 0 ... length_s. Beyond the end, the last pace continues.
  Time run_time(double film_s) const;
  /// Inverse of `run_time`.
  double film_s(Time run_time) const;
  /// Playback speed (run time / film time) at a run time.
  double speed(Time run_time) const;

 private:
  /// Node of the plan. Between two nodes, the pace is linear in run time.
  struct Node {
    double run_s;
    double pace;
    double film_s;
  };
  const Node& node_before(double Node::*along, double value) const;
  double pace_after(const Node& node, double run_s) const;

  std::vector<Node> nodes_;
};

}  // namespace patrol::render
