#pragma once

#include <string>

#include "app/common/progress_bar.h"
#include "app/run/run_loop.h"

namespace patrol::app {

/// Shows the progress of a run in one line of the terminal. Stops the run when the user interrupts it.
class ProgressLine final : public RunObserver {
 public:
  /// `time_limit_s`: limit of the simulated time, from which the line bounds the remaining time.
  ProgressLine(std::string name, double time_limit_s);

  bool is_interrupted() const override { return interrupt_.is_interrupted(); }
  bool keep_running(Time now, double distance_m) override;
  /// Lets signals end the process again.
  void end_simulation() override { interrupt_.release(); }

 private:
  std::string name_;
  double time_limit_s_;
  ProgressBar bar_;
  InterruptGuard interrupt_;
};

}  // namespace patrol::app
