#pragma once

#include <chrono>

#include "app/common/progress_bar.h"
#include "app/run/run_loop.h"
#include "app/run/run_view.h"

namespace patrol::app {

/// Shows a running simulation in the terminal (`patrol run --watch`), at most ten times a second. Restores the screen
/// at the end of the simulation or on destruction.
class TerminalView final : public RunObserver {
 public:
  /// Throws InputError if standard output is not a terminal.
  explicit TerminalView(const std::string& name);
  ~TerminalView() override;
  TerminalView(const TerminalView&) = delete;
  TerminalView& operator=(const TerminalView&) = delete;

  void begin(const ScenarioFiles& files) override;
  void on_message(const stack::StackMessage& message) override;
  void on_ground_truth(const GroundTruth& truth) override;
  bool is_interrupted() const override { return interrupt_.is_interrupted(); }
  bool keep_running(Time now, double distance_m) override;
  /// Restores the screen, and lets signals end the process again.
  void end_simulation() override;

 private:
  void restore_screen();

  bool is_shown_ = true;
  RunView run_;
  std::optional<Pose2> T_world_map_;
  std::optional<Pose2> T_world_body_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_frame_{};
  InterruptGuard interrupt_;
};

}  // namespace patrol::app
