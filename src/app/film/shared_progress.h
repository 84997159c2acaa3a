#pragma once

#include <atomic>
#include <cstddef>

namespace patrol::app {

/// Completed fraction of each part of a work, in memory that this process shares with processes forked from it.
class SharedProgress {
 public:
  /// Throws std::runtime_error if the memory cannot be allocated.
  explicit SharedProgress(std::size_t num_parts);
  ~SharedProgress();
  SharedProgress(const SharedProgress&) = delete;
  SharedProgress& operator=(const SharedProgress&) = delete;

  void set(std::size_t part, double done) { done_[part] = done; }
  /// Completed fraction of the whole work: the mean of the parts.
  double mean() const;

 private:
  std::size_t num_bytes() const { return num_parts_ * sizeof(std::atomic<double>); }

  std::size_t num_parts_;
  std::atomic<double>* done_ = nullptr;
};

}  // namespace patrol::app
