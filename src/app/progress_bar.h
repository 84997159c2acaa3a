#pragma once

#include <string>

#include "core/time.h"

namespace patrol::app {

/// One line on standard error that is redrawn in place; silent when standard error is no terminal.
class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(const std::string& line);
  /// A line that stays, above it; said without a terminal too.
  void say(const std::string& line);

 private:
  bool is_terminal_;
  bool has_drawn_ = false;
};

/// Counts SIGINT (Ctrl-C), SIGTERM and SIGHUP (closed terminal) instead of ending the process at the first one, while it lives. A SIGHUP
/// that the caller ignores (nohup) stays ignored.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  bool is_interrupted() const;
};

}  // namespace patrol::app
