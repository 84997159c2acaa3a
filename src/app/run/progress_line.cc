#include "app/run/progress_line.h"

#include <utility>

#include <fmt/format.h>

namespace patrol::app {

ProgressLine::ProgressLine(std::string name, double time_limit_s)
    : name_(std::move(name)), time_limit_s_(time_limit_s) {}

bool ProgressLine::keep_running(Time now, double distance_m) {
  const double now_s = to_seconds(now);
  bar_.show(fmt::format("{}  {:6.1f} s simulated  {:6.1f} m traveled", name_, now_s, distance_m), now_s / time_limit_s_,
            "at most ");
  return !interrupt_.is_interrupted();
}

}  // namespace patrol::app
