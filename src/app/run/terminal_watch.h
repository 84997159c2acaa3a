#pragma once

#include <chrono>

#include "app/common/progress_bar.h"
#include "app/run/run_loop.h"
#include "app/run/watch_frame.h"

namespace patrol::app {

/// Shows a running simulation in the terminal (`patrol run --watch`), at most ten times a second. Restores the screen
/// on destruction.
class TerminalWatch final : public RunObserver {
 public:
  /// Throws InputError if standard output is not a terminal.
  explicit TerminalWatch(const std::string& name);
  ~TerminalWatch() override;
  TerminalWatch(const TerminalWatch&) = delete;
  TerminalWatch& operator=(const TerminalWatch&) = delete;

  void begin(const ScenarioFiles& files) override;
  void see(const stack::StackMessage& message) override;
  void see(const GroundTruth& truth) override;
  bool go_on(Time now, double distance_m) override;

 private:
  WatchedRun run_;
  std::optional<Pose2> T_world_map_;
  std::optional<Pose2> T_world_body_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point drawn_{};
  InterruptGuard interrupt_;
};

}  // namespace patrol::app
