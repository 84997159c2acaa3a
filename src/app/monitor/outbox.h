#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "monitor/result.h"

namespace patrol::app {

/// What a run has to tell the platform, on disk before anything is sent: `outbox.jsonl`, one result a line, only ever longer, and
/// `outbox.sent`, how many bytes of it the platform has. Results that the platform refuses for good go to `outbox.refused.jsonl`.
///
/// One thread adds, one sends. A result whose sending was not acknowledged is sent again: the platform knows it by its id.
class Outbox {
 public:
  /// Goes on with what is there. Throws InputError when the directory cannot be written to.
  explicit Outbox(std::filesystem::path root);
  ~Outbox();
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;

  /// In the file when it returns: it outlives the process. Throws std::runtime_error when the disk is full.
  void add(const monitor::Result& result);

  struct Batch {
    std::vector<std::string> results;  ///< JSON each
    std::uint64_t end = 0;             ///< in the file
  };
  /// The oldest that were not sent, at most so many and so large (but one at least), and safe from a power cut. Empty: all were sent.
  Batch next(std::size_t max_results, std::size_t max_bytes);
  void mark_sent(const Batch& batch);
  void set_aside(const std::string& result);

  std::size_t num_waiting() const;
  std::size_t num_refused() const;
  std::filesystem::path file() const { return root_ / "outbox.jsonl"; }

 private:
  std::filesystem::path root_;
  int file_ = -1;
  std::atomic<std::uint64_t> written_{0};
  std::uint64_t sent_ = 0;
};

/// Results in a directory that wait to be sent; 0 when it has no outbox.
std::size_t num_waiting_results(const std::filesystem::path& root);

}  // namespace patrol::app
