#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/time.h"
#include "io/mcap_format.h"

namespace patrol::io {

/// What its messages are.
struct McapChannel {
  std::string topic;
  std::string type;        ///< "sensor_msgs/msg/LaserScan"
  std::string definition;  ///< of the type, with all that it uses
};

/// One message as it stands in the file.
struct McapMessage {
  const McapChannel& channel;
  Time log_time;
  std::string_view cdr;
};

/// What to read of a file; by default everything.
struct McapSelection {
  std::vector<std::string> topics;  ///< all if empty
  Time from = Time::min();          ///< log time
  Time to = Time::max();            ///< log time, included
  bool use_summary = true;          ///< else the file is read from front to back, and a damaged summary does no harm
};

/// Reads a file's messages in their order, with the help of the summary when there is one: chunks that hold nothing of
/// the selection are passed over. A file that was cut off (by a crash) is read up to the cut.
///
/// Throws InputError, naming file and byte, when it is no MCAP file or damaged otherwise.
class McapReader {
 public:
  explicit McapReader(const std::filesystem::path& path, McapSelection selection = {});

  /// The next message; it lives until the next call. None at the end, or at the cut. After damage another call goes on with the record
  /// behind the damaged one; where that begins cannot be told of every damage: then the same is thrown again.
  std::optional<McapMessage> next();

  /// Whether the writer came to its end: the file has its summary.
  bool is_complete() const { return footer_start_ > 0; }

  /// Share of the file that was read, 0 ... 1.
  double progress() const { return size_ > 0 ? static_cast<double>(offset_) / static_cast<double>(size_) : 1.0; }

  /// Log time of the last message, as the summary says; none in a file that was cut off.
  std::optional<Time> last_time() const { return last_time_; }

 private:
  std::string read_bytes(std::uint64_t offset, std::uint64_t size);
  void find_footer();
  void read_summary(std::uint64_t start, std::uint64_t end);
  void note_chunk(mcap::Fields content);
  void note_schema(mcap::Fields content);
  void note_channel(mcap::Fields content);
  bool read_record();
  std::optional<McapMessage> read_message(mcap::Fields content);
  std::string unpack_chunk(mcap::Fields content) const;
  bool is_wanted(const std::string& topic) const;
  [[noreturn]] void fail(const std::string& what) const;

  std::filesystem::path path_;
  std::ifstream file_;
  McapSelection selection_;
  std::uint64_t size_ = 0;
  std::uint64_t footer_start_ = 0;
  std::uint64_t offset_ = 0;        ///< of the next record in the file
  std::uint64_t record_start_ = 0;  ///< of the record at hand, for messages about damage
  bool is_at_end_ = false;
  std::optional<Time> last_time_;

  struct Schema {
    std::string type, definition;
  };
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, McapChannel> channels_;
  std::set<std::uint64_t> unwanted_chunks_;  ///< by offset
  std::string record_, chunk_;
  std::string_view rest_of_chunk_;  ///< of chunk_
};

/// Calls `handle` for every message of the selection, in the file's order. Returns whether the file is complete.
bool read_mcap(const std::filesystem::path& path, const std::function<void(const McapMessage&)>& handle,
               const McapSelection& selection = {});

}  // namespace patrol::io
