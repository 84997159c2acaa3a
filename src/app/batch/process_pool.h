#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace patrol::app {

/// How a process that did one task ended.
struct TaskEnd {
  std::size_t task = 0;
  int exit_code = 0;
  int signal = 0;             ///< that killed it; 0: it ended by itself
  bool is_over_time = false;  ///< we killed it
  std::string last_words;     ///< the last line that it wrote to standard error
};

struct ProcessPoolSettings {
  int num_processes = 1;
  double limit_s = 3600.0;  ///< of wall time, for one task
};

/// Does tasks 0 ... num_tasks - 1, each in a process of its own that is forked from this one: a crash, a leak or a hang of one is its
/// own, what it has of globals is its own, and starting it takes a millisecond. Must be called from a program of one thread.
///
/// `task` is called in the child, its result is the child's exit status; `on_end` here, in the order in which they end.
/// `keep_going` is asked at least five times a second; when it says no, all are killed, and the result is false.
bool run_in_processes(std::size_t num_tasks, const ProcessPoolSettings& settings, const std::function<int(std::size_t)>& task,
                      const std::function<void(const TaskEnd&)>& on_end, const std::function<bool()>& keep_going);

}  // namespace patrol::app
