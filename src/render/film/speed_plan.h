#pragma once

#include <vector>

#include "core/time.h"

namespace patrol::render {

/// A part of a run.
struct TimeSpan {
  Time from{}, to{};
};

struct SpeedSettings {
  double fast = 8.0;  ///< seconds of the run in a second of film
  double slow = 2.0;  ///< likewise, where there is something to see; not slower than `fast` asks for already
  double ramp_s = 1.25;  ///< of film, that going over from the one to the other takes
};

/// Which instant of a run each instant of its film shows. The film's pace (seconds of film for a second of the run) is 1 / fast,
/// and 1 / slow in the slow spans; before and after each it changes linearly with the run's time. So a film of a run of T seconds
/// with slow spans of L_i seconds and whole ramps of r = 2 ramp_s / (1 / fast + 1 / slow) seconds is
///   T / fast + sum_i (L_i + r) (1 / slow - 1 / fast)
/// seconds long.
class SpeedPlan {
 public:
  /// Spans whose ramps meet become one; what reaches beyond the run is cut off.
  SpeedPlan(TimeSpan run, std::vector<TimeSpan> slow_spans, const SpeedSettings& settings);

  double length_s() const { return nodes_.back().film_s; }
  /// The run's instant at `film_s`, 0 ... length_s; beyond, the run goes on at the pace that it had.
  Time run_time(double film_s) const;
  /// The inverse.
  double film_s(Time run_time) const;
  /// Seconds of the run in a second of film, at an instant of the run.
  double speed(Time run_time) const;

 private:
  /// Between two of them, the pace is linear in the run's time.
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
