#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace patrol {

/// Worker that executes tasks beside its owner, in the order in which they are given. With or without a thread the
/// tasks and their order are the same, so that results are too, if the owner waits for a task before it uses what the
/// task writes, and neither changes what the other reads.
class BackgroundWorker {
 public:
  using Ticket = std::uint64_t;

  /// Without a thread, `submit` executes the task.
  explicit BackgroundWorker(bool has_thread);
  /// Waits for the tasks.
  ~BackgroundWorker();
  BackgroundWorker(const BackgroundWorker&) = delete;
  BackgroundWorker& operator=(const BackgroundWorker&) = delete;

  /// Returns the ticket to wait for the task.
  Ticket submit(std::function<void()> task);
  /// Waits until the task and all before it are done. Throws the first exception of a task; the tasks after it are not
  /// executed.
  void wait(Ticket ticket);
  /// Executes a task and waits for it.
  void run(std::function<void()> task) { wait(submit(std::move(task))); }

  /// Returns the wall time that the thread has spent on tasks.
  double busy_s() const;

 private:
  void execute_tasks();

  mutable std::mutex mutex_;
  std::condition_variable has_task_, has_done_;
  std::deque<std::function<void()>> tasks_;
  Ticket num_submitted_ = 0, num_done_ = 0;
  bool is_ending_ = false;
  double busy_s_ = 0.0;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace patrol
