#pragma once

#include <filesystem>
#include <thread>

namespace patrol::link {

/// Pipe for the output of a process that is started before the file for it exists. Until then, a process that writes
/// more than the pipe holds (1 MiB, or 64 KiB where the system allows no more) waits.
class ProcessOutput {
 public:
  /// Throws std::runtime_error if the pipe cannot be created.
  ProcessOutput();
  ~ProcessOutput();
  ProcessOutput(const ProcessOutput&) = delete;
  ProcessOutput& operator=(const ProcessOutput&) = delete;

  /// End for the process.
  int writing_end() const { return writing_end_; }
  /// Closes the end for the process in this process, after the fork.
  void close_writing_end();

  /// Appends the output to a file from now on, beginning with what the pipe holds. Throws InputError if the file cannot
  /// be written.
  void write_to(const std::filesystem::path& file);
  /// Writes what the pipe holds, and ends. Processes that still have the pipe open are not waited for.
  void finish();

 private:
  void copy_until_finished();

  int reading_end_ = -1, writing_end_ = -1;
  int file_ = -1;
  int finish_event_ = -1;
  std::thread thread_;  ///< copies the output
};

}  // namespace patrol::link
