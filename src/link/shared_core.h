#pragma once

#include <sys/types.h>

#include <cstddef>
#include <optional>

#include <sched.h>

namespace patrol::link {

/// Core of the process at the other end of a connection, to which a thread is bound while it waits for that process. A
/// thread that is woken on the same core continues after a few microseconds. On another core it waits until that core
/// has left its idle state, or until another thread has left the core.
///
/// Not thread-safe: for one thread.
class SharedCore {
 public:
  /// `process`: the other one. Its main thread is the one that sends.
  explicit SharedCore(pid_t process);
  ~SharedCore();
  SharedCore(const SharedCore&) = delete;
  SharedCore& operator=(const SharedCore&) = delete;

  /// Binds the calling thread to the core on which the other process is now, and restores its cores at the end. Binds
  /// nothing where that core is unknown or the thread is not allowed to use it.
  class Binding {
   public:
    /// `core`: null binds nothing.
    explicit Binding(SharedCore* core) : core_(core != nullptr && core->bind() ? core : nullptr) {}
    ~Binding() {
      if (core_ != nullptr) core_->release();
    }
    Binding(const Binding&) = delete;
    Binding& operator=(const Binding&) = delete;

   private:
    SharedCore* core_;
  };

 private:
  bool bind();
  void release();
  std::optional<std::size_t> read_core() const;

  int file_;           ///< status of the other thread in /proc; -1: none
  cpu_set_t cores_{};  ///< allowed cores of the thread before it was bound
};

}  // namespace patrol::link
