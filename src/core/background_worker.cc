#include "core/background_worker.h"

#include <chrono>
#include <utility>

namespace patrol {

BackgroundWorker::BackgroundWorker(bool has_thread) {
  if (has_thread) thread_ = std::thread([this] { execute_tasks(); });
}

BackgroundWorker::~BackgroundWorker() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  has_task_.notify_one();
  thread_.join();
}

BackgroundWorker::Ticket BackgroundWorker::submit(std::function<void()> task) {
  if (!thread_.joinable()) {
    task();
    return 0;
  }
  Ticket ticket = 0;
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
    ticket = ++num_submitted_;
  }
  has_task_.notify_one();
  return ticket;
}

void BackgroundWorker::wait(Ticket ticket) {
  std::unique_lock lock(mutex_);
  has_done_.wait(lock, [&] { return num_done_ >= ticket; });
  if (failure_) std::rethrow_exception(failure_);
}

double BackgroundWorker::busy_s() const {
  const std::lock_guard lock(mutex_);
  return busy_s_;
}

void BackgroundWorker::execute_tasks() {
  std::unique_lock lock(mutex_);
  while (true) {
    has_task_.wait(lock, [&] { return !tasks_.empty() || is_ending_; });
    if (tasks_.empty()) return;
    const std::function<void()> task = std::move(tasks_.front());
    tasks_.pop_front();
    if (!failure_) {
      lock.unlock();
      std::exception_ptr failure;
      const auto start = std::chrono::steady_clock::now();
      try {
        task();
      } catch (...) {
        failure = std::current_exception();
      }
      const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
      lock.lock();
      busy_s_ += seconds;
      failure_ = failure;
    }
    ++num_done_;
    has_done_.notify_one();
  }
}

}  // namespace patrol
