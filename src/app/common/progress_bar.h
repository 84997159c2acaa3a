#pragma once

#include <chrono>
#include <string>

#include "core/time.h"

namespace patrol::app {

/// Line on standard error that is redrawn in place; silent if standard error is not a terminal.
class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(const std::string& line);
  /// Shows `line` with the remaining time, extrapolated from the completed `fraction` of the work, in [0, 1], and
  /// preceded by `qualifier`, such as "at most ". Redraws at most ten times per second.
  void show(const std::string& line, double fraction, const std::string& qualifier = "");
  /// Prints a permanent line above the progress line, also without a terminal.
  void print_line(const std::string& line);

 private:
  bool is_terminal_;
  bool is_shown_ = false;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_shown_{};
};

/// Remaining time of work whose `fraction` in [0, 1] took `elapsed_s`: "40 s left", "3 min left" or "2 h 5 min left".
/// Empty during the first second, and for a fraction of 0 or 1.
std::string remaining_text(double elapsed_s, double fraction);

/// Counts SIGINT (Ctrl-C), SIGTERM and SIGHUP (closed terminal) until `release` or its destruction, instead of ending
/// the process at the first one. A SIGHUP that the caller ignores (nohup) stays ignored.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  bool is_interrupted() const;
  /// Ends the counting: from now on a signal ends the process. `is_interrupted` keeps its value.
  void release();

 private:
  bool is_released_ = false;
};

}  // namespace patrol::app
