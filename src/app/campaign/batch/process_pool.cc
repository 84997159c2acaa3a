#include "app/campaign/batch/process_pool.h"

#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "app/common/exit_code.h"
#include "core/error.h"

namespace patrol::app {
namespace {

using Clock = std::chrono::steady_clock;
using File = std::unique_ptr<std::FILE, decltype(&std::fclose)>;

class Child {
 public:
  Child(std::size_t number, double timeout_s, const std::function<int(std::size_t)>& task)
      : task_(number),
        stderr_file_(std::tmpfile(), std::fclose),
        deadline_(Clock::now() +
                  std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timeout_s))) {
    if (!stderr_file_)
      throw std::runtime_error(fmt::format("cannot create a temporary file: {}", std::strerror(errno)));
    std::fflush(nullptr);  // otherwise both processes would write the buffer
    const pid_t parent = ::getpid();
    pid_ = ::fork();
    if (pid_ < 0) throw std::runtime_error(fmt::format("cannot start a process: {}", std::strerror(errno)));
    if (pid_ == 0) run_child(parent, task);
    pidfd_ = static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0));  // not pidfd_open: glibc 2.36 declares it for C only
  }
  ~Child() {
    if (pid_ > 0) {
      kill();
      ::waitpid(pid_, nullptr, 0);
    }
    if (pidfd_ >= 0) ::close(pidfd_);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  int pidfd() const { return pidfd_; }
  bool is_late(Clock::time_point now) const { return now >= deadline_; }
  void kill() const { ::kill(pid_, SIGKILL); }
  void kill_for_time() {
    is_over_time_ = true;
    kill();
  }

  /// Whether the child has ended; then fills `end`.
  bool collect(TaskEnd& end) {
    int status = 0;
    if (::waitpid(pid_, &status, WNOHANG) != pid_) return false;
    pid_ = -1;
    end = {.task = task_,
           .exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 0,
           .signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0,
           .is_over_time = is_over_time_ && WIFSIGNALED(status),
           .last_stderr_line = last_stderr_line()};
    return true;
  }

 private:
  /// Code of the child process.
  [[noreturn]] void run_child(pid_t parent, const std::function<int(std::size_t)>& task) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) std::_Exit(EXIT_FAILURE);  // the parent died before prctl
    std::signal(SIGINT, SIG_IGN);                         // Ctrl-C reaches all processes; the parent decides
    std::signal(SIGHUP, SIG_IGN);                         // a closed terminal too
    std::signal(SIGTERM, SIG_DFL);
    const rlimit no_core{0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core);
    ::dup2(::fileno(stderr_file_.get()), STDERR_FILENO);
    ::dup2(::fileno(stderr_file_.get()), STDOUT_FILENO);
    const int code = code_of(task);
    std::fflush(nullptr);
    std::_Exit(code);
  }

  /// Returns the exit code of the task. No exception may leave it: unwinding would destroy the copies of the parent's
  /// children, which kills them.
  int code_of(const std::function<int(std::size_t)>& task) const {
    try {
      return task(task_);
    } catch (const InputError& error) {
      fmt::print(stderr, "{}\n", error.what());
      return static_cast<int>(ExitCode::kWrongInput);
    } catch (const std::exception& error) {
      fmt::print(stderr, "{}\n", error.what());
    } catch (...) {
      fmt::print(stderr, "unknown exception\n");
    }
    return static_cast<int>(ExitCode::kProgramFailed);
  }

  std::string last_stderr_line() {
    constexpr long kEnough = 4096;
    std::fseek(stderr_file_.get(), 0, SEEK_END);
    std::fseek(stderr_file_.get(), std::max(0L, std::ftell(stderr_file_.get()) - kEnough), SEEK_SET);
    std::string text(kEnough, '\0');
    text.resize(std::fread(text.data(), 1, text.size(), stderr_file_.get()));
    while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
    return text.substr(text.find_last_of('\n') + 1);
  }

  std::size_t task_;
  File stderr_file_;
  Clock::time_point deadline_;
  pid_t pid_ = -1;
  int pidfd_ = -1;
  bool is_over_time_ = false;
};

/// Waits until a child ends, at most 0.2 s.
void wait_for_any(const std::vector<std::unique_ptr<Child>>& children) {
  constexpr int kMaxWait_ms = 200;
  std::vector<pollfd> ends;
  for (const auto& child : children) ends.push_back({.fd = child->pidfd(), .events = POLLIN, .revents = 0});
  ::poll(ends.data(), ends.size(), kMaxWait_ms);
}

}  // namespace

bool run_in_processes(std::size_t num_tasks, const ProcessPoolSettings& settings,
                      const std::function<int(std::size_t)>& task, const std::function<void(const TaskEnd&)>& on_end,
                      const std::function<bool()>& keep_going) {
  std::vector<std::unique_ptr<Child>> children;
  for (std::size_t next = 0; next < num_tasks || !children.empty();) {
    if (!keep_going()) return false;  // destructors kill the children
    while (next < num_tasks && static_cast<int>(children.size()) < settings.num_processes) {
      children.push_back(std::make_unique<Child>(next++, settings.timeout_s, task));
    }
    wait_for_any(children);
    for (auto child = children.begin(); child != children.end();) {
      TaskEnd end;
      if ((*child)->is_late(Clock::now())) (*child)->kill_for_time();
      if (!(*child)->collect(end)) {
        ++child;
        continue;
      }
      child = children.erase(child);
      on_end(end);
    }
  }
  return true;
}

}  // namespace patrol::app
