#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace patrol::app {

/// End of the process of one task.
struct TaskEnd {
  std::size_t task = 0;
  int exit_code = 0;
  int signal = 0;                ///< signal that killed the process; 0 if it exited
  bool is_over_time = false;     ///< killed by the pool at the time limit
  std::string last_stderr_line;  ///< last line of its standard error
};

struct ProcessPoolSettings {
  int num_processes = 1;
  double timeout_s = 3600.0;  ///< wall-clock limit of a task
};

/// Runs tasks 0 ... num_tasks - 1, each in a process of its own that is forked from this one. Crashes, leaks, hangs and
/// global variables of a task do not affect others, and a start takes 1 ms. Must be called from a program with one
/// thread.
///
/// `task` is called in the child; its result is the child's exit status. `on_end` is called here, in the order in which
/// the tasks end. `keep_going` is called at least five times per second; if it returns false, all children are killed,
/// and the result is false.
bool run_in_processes(std::size_t num_tasks, const ProcessPoolSettings& settings,
                      const std::function<int(std::size_t)>& task, const std::function<void(const TaskEnd&)>& on_end,
                      const std::function<bool()>& keep_going);

}  // namespace patrol::app
