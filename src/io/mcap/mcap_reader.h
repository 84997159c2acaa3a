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
#include <utility>
#include <vector>

#include "core/time.h"
#include "io/mcap/mcap_format.h"

namespace patrol::io {

/// Channel of an MCAP file: topic and message type.
struct McapChannel {
  std::string topic;
  std::string type;                                         ///< "sensor_msgs/msg/LaserScan"
  std::string definition;                                   ///< message definition, including all types that it uses
  std::string schema_encoding = {}, message_encoding = {};  ///< "ros2msg" and "cdr" for ROS 2
};

/// Serialized message of an MCAP file. Valid until the next call of the reader.
struct McapMessage {
  const McapChannel& channel;
  Time log_time;
  std::string_view cdr;
};

/// Order in which messages are read.
enum class McapOrder {
  kFile,
  /// Order by log time; equal times in the order of the file. Needs a summary with the channels, and all messages in
  /// chunks: other files are read sequentially, without their summary. Memory: the chunks that overlap in time.
  kLogTime,
};

/// Selection of the messages to read; all by default.
struct McapSelection {
  std::vector<std::string> topics;  ///< all if empty
  Time from = Time::min();          ///< log time
  Time to = Time::max();            ///< log time, inclusive
  McapOrder order = McapOrder::kFile;
};

/// Reader of the messages of an MCAP file. Uses the summary, if present, to skip chunks without selected
/// messages. A truncated file (crash of the writer) is read up to the truncation.
///
/// Throws InputError with file and byte offset if the file is not MCAP or is otherwise damaged.
class McapReader {
 public:
  explicit McapReader(const std::filesystem::path& path, McapSelection selection = {});

  /// Returns the next message, valid until the next call; nullopt at the end or truncation. After an InputError another
  /// call continues with the record after the damaged one. If that record cannot be found, the same error is thrown
  /// again.
  std::optional<McapMessage> next();

  /// Returns whether the writer closed the file: the summary is present.
  bool is_complete() const { return footer_start_ > 0; }

  /// Returns the fraction of the file read, 0 to 1.
  double progress() const;

  /// Returns the topics of the channels in the summary; nullopt if the file has no summary with channels.
  std::optional<std::set<std::string>> topics() const;

  /// Returns the log time of the last message according to the summary; nullopt in a truncated file.
  std::optional<Time> last_time() const { return last_time_; }

 private:
  /// Chunk of the file, for reading by log time.
  struct ChunkEntry {
    Time start{};  ///< log time of its first message, by its header
    std::uint64_t offset = 0, length = 0;
  };
  /// Unpacked chunk with the messages that have not been read.
  struct OpenChunk {
    std::string bytes;
    std::vector<std::pair<Time, std::string_view>> messages;  ///< content of the records, by log time
    std::size_t next = 0;                                     ///< index of the next message
  };
  using OpenChunks = std::map<std::pair<Time, std::uint64_t>, OpenChunk>;  ///< chunks by next message: time and offset

  void open_by_time();
  std::optional<std::vector<ChunkEntry>> find_chunks();
  std::optional<McapMessage> next_by_time();
  void open_chunk(const ChunkEntry& entry);
  std::optional<McapMessage> next_in_file();
  std::string read_bytes(std::uint64_t offset, std::uint64_t size);
  void find_footer();
  void read_summary(std::uint64_t start, std::uint64_t end);
  void add_chunk(mcap::RecordReader content);
  void add_schema(mcap::RecordReader content);
  void add_channel(mcap::RecordReader content);
  bool read_record();
  std::optional<McapMessage> read_message(mcap::RecordReader content);
  static std::string unpack_chunk(mcap::RecordReader content);
  bool is_wanted(const std::string& topic) const;
  [[noreturn]] void fail(const std::string& what) const;

  std::filesystem::path path_;
  std::ifstream file_;
  McapSelection selection_;
  std::uint64_t size_ = 0;
  std::uint64_t footer_start_ = 0;
  std::uint64_t offset_ = 0;        ///< offset of the next record in the file
  std::uint64_t record_start_ = 0;  ///< offset of the current record, for error messages
  bool is_at_end_ = false;
  std::optional<Time> last_time_;

  struct Schema {
    std::string type, definition, encoding;
  };
  std::map<std::uint16_t, Schema> schemas_ = {{std::uint16_t{0}, {}}};  ///< schemas by id; 0: none
  std::map<std::uint16_t, McapChannel> channels_;
  std::set<std::string> summary_channels_;   ///< topics of the channels in the summary
  std::set<std::uint64_t> unwanted_chunks_;  ///< offsets of the chunks in the file
  std::string record_, chunk_;
  std::string_view rest_of_chunk_;  ///< unread part of chunk_

  bool is_by_time_ = false;
  std::vector<ChunkEntry> chunks_by_time_;
  std::size_t num_opened_ = 0;  ///< number of chunks_by_time_ that are or were open
  OpenChunks open_chunks_;
  OpenChunks::node_type last_chunk_;  ///< chunk of the last message if it was the last one of its chunk
};

/// Calls `handle` for each selected message. Returns whether the file is complete.
bool read_mcap(const std::filesystem::path& path, const std::function<void(const McapMessage&)>& handle,
               const McapSelection& selection = {});

/// Returns the log time of the last message, in a truncated file up to the truncation. Throws InputError if the file
/// has no messages.
Time last_message_time(const std::filesystem::path& path);

}  // namespace patrol::io
