#pragma once

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
  /// Prints a permanent line above the progress line, also without a terminal.
  void print_line(const std::string& line);

 private:
  bool is_terminal_;
  bool is_shown_ = false;
};

/// Counts SIGINT (Ctrl-C), SIGTERM and SIGHUP (closed terminal) during its lifetime, instead of ending the process at
/// the first one. A SIGHUP that the caller ignores (nohup) stays ignored.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  bool is_interrupted() const;
};

}  // namespace patrol::app
