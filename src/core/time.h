#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>

namespace patrol {

/// Time since the start of the run, or a duration. Integer nanoseconds: schedules do not drift and stamps compare
/// exactly.
using Time = std::chrono::nanoseconds;

constexpr double to_seconds(Time time) { return static_cast<double>(time.count()) * 1e-9; }

inline Time from_seconds(double seconds) { return Time{static_cast<std::int64_t>(std::llround(seconds * 1e9))}; }

}  // namespace patrol
