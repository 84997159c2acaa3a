#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "monitor/result.h"

namespace patrol::app {

/// Queue of results for the monitoring server on disk. `outbox.jsonl` has one result per line and is only appended to;
/// `outbox.sent` has the number of its bytes that the server has acknowledged. Results that the server rejects go to
/// `outbox.refused.jsonl`.
///
/// One thread adds, another one sends. A result without acknowledgment is sent again; the server identifies it by its
/// id.
class Outbox {
 public:
  /// Continues an existing outbox. Throws InputError if the directory is not writable.
  explicit Outbox(std::filesystem::path root);
  ~Outbox();
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;

  /// Appends a result to the file; it survives the end of the process. Throws std::runtime_error if the disk is full.
  void add(const monitor::Result& result);

  struct Batch {
    std::vector<std::string> results;  ///< one JSON text each
    std::uint64_t end = 0;             ///< end of the batch in the file, bytes
  };
  /// Oldest results that were not sent, at most `max_results` and `max_bytes` (but at least one), synchronized to disk.
  /// Empty if all were sent.
  Batch next(std::size_t max_results, std::size_t max_bytes);
  void mark_sent(const Batch& batch);
  /// Appends a result that the server rejects to `outbox.refused.jsonl`. Throws OutputError if the disk is full,
  /// without a part of the result in the file.
  void set_aside(const std::string& result);

  std::size_t num_pending() const;
  std::size_t num_rejected() const;
  std::filesystem::path file() const { return root_ / "outbox.jsonl"; }

 private:
  std::filesystem::path root_;
  int file_ = -1;
  std::atomic<std::uint64_t> written_{0};
  std::uint64_t sent_ = 0;
};

/// Number of results in a directory that wait for upload; 0 without an outbox.
std::size_t num_pending_results(const std::filesystem::path& root);

}  // namespace patrol::app
