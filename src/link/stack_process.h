#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "link/process_output.h"

namespace patrol::link {

/// Splits a command line into words at blanks. Quotation marks (' or ") and backslashes protect blanks; nothing else is
/// special: no shell reads the command. Throws InputError if it has no word or a quotation mark is not closed.
std::vector<std::string> command_words(const std::string& command);

/// Returns the executable file of a program, found by PATH unless its name has a slash; nullopt if it is not found or
/// cannot be executed.
std::optional<std::filesystem::path> find_program(const std::string& program);

/// Throws InputError if a program is not found by PATH or cannot be executed.
void check_program(const std::string& program);

/// Start of the process of a stack.
struct ProcessSettings {
  std::vector<std::string> words;                  ///< program, found by PATH, and its arguments
  std::map<std::string, std::string> environment;  ///< variables in addition to those of this process
  std::optional<std::uint64_t> memory_bytes = {};  ///< limit of the address space
};

/// Child process in a process group of its own, which the destructor kills. Its output waits in a pipe until there is a
/// file for it.
class StackProcess {
 public:
  /// Throws InputError if the program cannot be started.
  explicit StackProcess(const ProcessSettings& settings);
  ~StackProcess();
  StackProcess(const StackProcess&) = delete;
  StackProcess& operator=(const StackProcess&) = delete;

  /// Appends standard output and standard error to a file from now on, beginning with the output before. Throws
  /// InputError if the file cannot be written.
  void write_output_to(const std::filesystem::path& file) { output_.write_to(file); }

  pid_t id() const { return id_; }
  bool is_running();
  /// Waits for the end of the process, for at most `timeout`, then asks it to end, and kills it. Returns whether it
  /// ended within `timeout`.
  bool stop(std::chrono::steady_clock::duration timeout);
  /// Returns whether it has ended by a signal or with another code than 0.
  bool has_failed();
  /// Description of the end: "exited with code 1" or "was killed by signal 9 (Killed)"; empty while it runs.
  std::string end_text();

 private:
  bool wait_for(std::chrono::steady_clock::duration timeout);

  ProcessOutput output_;
  pid_t id_ = -1;
  std::optional<int> status_;
};

/// CPU time of a process, with all its threads but without its children; nullopt if it is gone or belongs to another
/// user.
std::optional<double> cpu_seconds_of(pid_t process);

}  // namespace patrol::link
