#include "render/film/speed_plan.h"

#include <algorithm>
#include <cmath>

namespace patrol::render {
namespace {

/// Sorts the spans, clips them to the run and merges those whose ramps overlap.
std::vector<TimeSpan> merge_spans(std::vector<TimeSpan> spans, TimeSpan run, Time ramp) {
  std::ranges::sort(spans, {}, &TimeSpan::from);
  std::vector<TimeSpan> apart;
  for (TimeSpan span : spans) {
    span = {std::max(span.from, run.from), std::min(span.to, run.to)};
    if (span.to <= span.from) continue;
    if (!apart.empty() && span.from - apart.back().to < 2 * ramp) apart.back().to = std::max(apart.back().to, span.to);
    else apart.push_back(span);
  }
  return apart;
}

}  // namespace

SpeedPlan::SpeedPlan(TimeSpan run, std::vector<TimeSpan> slow_spans, const SpeedSettings& settings) {
  const double fast_pace = 1.0 / settings.fast, slow_pace = std::max(1.0 / settings.slow, fast_pace);
  const double ramp_s = 2.0 * settings.ramp_s / (fast_pace + slow_pace);
  const double begin_s = to_seconds(run.from), end_s = to_seconds(run.to);
  // A ramp cut by the end of the run keeps its slope.
  const auto ramp_pace = [&](double away_s) {
    return std::max(fast_pace, slow_pace - away_s / ramp_s * (slow_pace - fast_pace));
  };
  const auto add = [&](double run_s, double pace) {
    if (nodes_.empty()) return nodes_.push_back({run_s, pace, 0.0});
    const Node& last = nodes_.back();
    if (run_s > last.run_s)
      nodes_.push_back({run_s, pace, last.film_s + 0.5 * (last.pace + pace) * (run_s - last.run_s)});
  };
  const std::vector<TimeSpan> spans = merge_spans(std::move(slow_spans), run, from_seconds(ramp_s));
  const double first_s = spans.empty() ? end_s : to_seconds(spans.front().from);
  add(begin_s, spans.empty() ? fast_pace : ramp_pace(first_s - begin_s));
  for (const TimeSpan& span : spans) {
    const double from_s = to_seconds(span.from), to_s = to_seconds(span.to);
    if (from_s - ramp_s > begin_s) add(from_s - ramp_s, fast_pace);
    add(from_s, slow_pace);
    add(to_s, slow_pace);
    if (to_s + ramp_s < end_s) add(to_s + ramp_s, fast_pace);
  }
  add(end_s, spans.empty() ? fast_pace : ramp_pace(end_s - to_seconds(spans.back().to)));
}

const SpeedPlan::Node& SpeedPlan::node_before(double Node::*along, double value) const {
  const auto after = std::ranges::upper_bound(nodes_, value, {}, along);
  return after == nodes_.begin() ? nodes_.front() : *(after - 1);
}

double SpeedPlan::pace_after(const Node& node, double run_s) const {
  if (&node == &nodes_.back()) return node.pace;
  const Node& next = *(&node + 1);
  return node.pace + (run_s - node.run_s) / (next.run_s - node.run_s) * (next.pace - node.pace);
}

double SpeedPlan::film_s(Time run_time) const {
  const double run_s = to_seconds(run_time);
  const Node& node = node_before(&Node::run_s, run_s);
  return node.film_s + 0.5 * (node.pace + pace_after(node, run_s)) * (run_s - node.run_s);
}

// Solves film_s - node.film_s = pace x + slope x^2 / 2 for x = run_s - node.run_s, in a form that is stable for slope =
// 0.
Time SpeedPlan::run_time(double film_s) const {
  const Node& node = node_before(&Node::film_s, film_s);
  const double slope = pace_after(node, node.run_s + 1.0) - node.pace;
  const double missing_s = film_s - node.film_s;
  const double x =
      2.0 * missing_s / (node.pace + std::sqrt(std::max(0.0, node.pace * node.pace + 2.0 * slope * missing_s)));
  return from_seconds(node.run_s + x);
}

double SpeedPlan::speed(Time run_time) const {
  const double run_s = to_seconds(run_time);
  return 1.0 / pace_after(node_before(&Node::run_s, run_s), run_s);
}

}  // namespace patrol::render
