#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace patrol::render {

/// FIFO queue between threads. Thread-safe.
template <typename Work>
class WorkQueue {
 public:
  void put(Work work) {
    {
      const std::lock_guard lock(mutex_);
      waiting_.push_back(std::move(work));
    }
    wake_.notify_one();
  }
  /// Waits for the next item. None after `close`, even when items remain.
  std::optional<Work> take() {
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [this] { return is_closed_ || !waiting_.empty(); });
    if (is_closed_) return std::nullopt;
    std::optional<Work> next = std::move(waiting_.front());
    waiting_.pop_front();
    return next;
  }
  void close() {
    {
      const std::lock_guard lock(mutex_);
      is_closed_ = true;
    }
    wake_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Work> waiting_;
  bool is_closed_ = false;
};

}  // namespace patrol::render
