#include "link/stack_process.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <sstream>
#include <thread>

#include <fmt/format.h>

#include "core/error.h"

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX declares it in no header

namespace patrol::link {
namespace {

constexpr std::chrono::milliseconds kPoll{5};
constexpr std::chrono::seconds kTimeToEnd{2};  ///< time for the exit of the process after a request to end

/// Environment of this process with further variables, "NAME=value".
std::vector<std::string> environment_with(const std::map<std::string, std::string>& variables) {
  std::vector<std::string> lines;
  for (char** line = environ; *line != nullptr; ++line) {
    const std::string text = *line;
    if (!variables.contains(text.substr(0, text.find('=')))) lines.push_back(text);
  }
  for (const auto& [name, value] : variables) lines.push_back(name + "=" + value);
  return lines;
}

std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// Child between fork and exec: only functions that are safe after a fork.
[[noreturn]] void execute(char* const* arguments, char** environment, int output, pid_t parent, int error_pipe,
                          const std::optional<std::uint64_t>& memory_bytes) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);  // the parent ended before prctl
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE}) std::signal(signal, SIG_DFL);
  const int nothing = ::open("/dev/null", O_RDONLY);
  if (nothing >= 0) {
    ::dup2(nothing, STDIN_FILENO);
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
    ::close(nothing);
    bool is_limited = true;
    if (memory_bytes) {
      const rlimit limit{.rlim_cur = *memory_bytes, .rlim_max = *memory_bytes};
      is_limited = ::setrlimit(RLIMIT_AS, &limit) == 0;
    }
    if (is_limited) {
      environ = environment;
      ::execvp(arguments[0], arguments);
    }
  }
  const int error = errno;
  [[maybe_unused]] const ssize_t written = ::write(error_pipe, &error, sizeof(error));
  ::_exit(127);
}

}  // namespace

std::vector<std::string> command_words(const std::string& command) {
  std::vector<std::string> words;
  std::optional<std::string> word;
  char quote = '\0';
  for (std::size_t i = 0; i < command.size(); ++i) {
    char next = command[i];
    if (quote == '\0' && (next == ' ' || next == '\t')) {
      if (word) words.push_back(*word);
      word.reset();
      continue;
    }
    if (!word) word.emplace();
    if (next == quote) {
      quote = '\0';
    } else if (quote == '\0' && (next == '\'' || next == '"')) {
      quote = next;
    } else {
      if (next == '\\' && quote != '\'' && i + 1 < command.size()) next = command[++i];
      *word += next;
    }
  }
  if (quote != '\0') throw InputError(fmt::format("command of the stack: {}: quotation mark is not closed", command));
  if (word) words.push_back(*word);
  if (words.empty() || words.front().empty()) throw InputError("command of the stack is empty");
  return words;
}

std::optional<std::filesystem::path> find_program(const std::string& program) {
  const auto is_executable = [](const std::filesystem::path& file) {
    return std::filesystem::is_regular_file(file) && ::access(file.c_str(), X_OK) == 0;
  };
  if (program.find('/') != std::string::npos) {
    if (is_executable(program)) return program;
  } else {
    const char* const path = std::getenv("PATH");
    std::istringstream folders(path != nullptr ? path : "/usr/bin:/bin");
    for (std::string folder; std::getline(folders, folder, ':');) {
      const std::filesystem::path file = std::filesystem::path(folder.empty() ? "." : folder) / program;
      if (is_executable(file)) return file;
    }
  }
  return std::nullopt;
}

void check_program(const std::string& program) {
  if (find_program(program)) return;
  if (std::filesystem::is_regular_file(program)) {
    const bool is_executable = ::access(program.c_str(), X_OK) == 0;
    throw InputError(fmt::format(
        "stack {}: {}", program,
        is_executable ? "program not found by PATH: must be ./" + program + " to start this file"
                      : "not executable: must be made executable (chmod +x) or be started by its interpreter"));
  }
  throw InputError(fmt::format("stack {}: program not found", program));
}

StackProcess::StackProcess(const ProcessSettings& settings) {
  std::vector<std::string> words = settings.words;
  std::vector<std::string> environment = environment_with(settings.environment);
  const std::vector<char*> arguments = pointers_to(words);
  std::vector<char*> variables = pointers_to(environment);
  int error_pipe[2];
  if (::pipe2(error_pipe, O_CLOEXEC) != 0) throw std::runtime_error(fmt::format("pipe: {}", std::strerror(errno)));
  const pid_t parent = ::getpid();
  id_ = ::fork();
  if (id_ == 0)
    execute(arguments.data(), variables.data(), output_.writing_end(), parent, error_pipe[1], settings.memory_bytes);
  ::close(error_pipe[1]);
  output_.close_writing_end();
  int error = 0;
  const bool failed = id_ < 0 || ::read(error_pipe[0], &error, sizeof(error)) > 0;
  if (id_ < 0) error = errno;
  ::close(error_pipe[0]);
  if (failed) throw InputError(fmt::format("stack {}: cannot be started: {}", words.front(), std::strerror(error)));
}

StackProcess::~StackProcess() { stop({}); }

bool StackProcess::is_running() { return !wait_for({}); }

bool StackProcess::stop(std::chrono::steady_clock::duration timeout) {
  const bool has_ended = wait_for(timeout);
  if (!has_ended) {
    ::kill(-id_, SIGTERM);
    ::kill(-id_, SIGCONT);
    wait_for(kTimeToEnd);
  }
  ::kill(-id_, SIGKILL);  // also the processes that the stack has started
  while (!status_) wait_for(kTimeToEnd);
  output_.finish();
  return has_ended;
}

bool StackProcess::wait_for(std::chrono::steady_clock::duration timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  while (!status_) {
    int status = 0;
    const pid_t ended = ::waitpid(id_, &status, WNOHANG);
    if (ended == id_) status_ = status;
    else if (ended < 0 && errno != EINTR) status_ = 0;
    else if (std::chrono::steady_clock::now() >= deadline) return false;
    else std::this_thread::sleep_for(kPoll);
  }
  return true;
}

bool StackProcess::has_failed() { return !is_running() && *status_ != 0; }

std::string StackProcess::end_text() {
  if (is_running()) return "";
  if (WIFSIGNALED(*status_))
    return fmt::format("was killed by signal {} ({})", WTERMSIG(*status_), ::strsignal(WTERMSIG(*status_)));
  return fmt::format("exited with code {}", WEXITSTATUS(*status_));
}

std::optional<double> cpu_seconds_of(pid_t process) {
  clockid_t clock{};
  timespec time{};
  if (::clock_getcpuclockid(process, &clock) != 0 || ::clock_gettime(clock, &time) != 0) return std::nullopt;
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace patrol::link
