#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/time.h"

namespace patrol::io {

/// Little-endian bytes of MCAP records (mcap.dev/spec).
class McapBytes {
 public:
  template <typename Integer>
  void number(Integer value) {
    for (std::size_t i = 0; i < sizeof(Integer); ++i) bytes_.push_back(static_cast<char>(value >> (8 * i)));
  }
  void text(std::string_view text);
  void raw(std::string_view bytes) { bytes_.append(bytes); }
  /// A record: opcode, length, content.
  void record(std::uint8_t opcode, const McapBytes& content);

  const std::string& bytes() const { return bytes_; }
  std::size_t size() const { return bytes_.size(); }
  void clear() { bytes_.clear(); }

 private:
  std::string bytes_;
};

/// Writes an MCAP file: profile ros2, schemas ros2msg, messages cdr, chunks compressed with zstd, a summary with indexes.
/// The same calls give the same bytes. What was written before a crash can be read up to the last whole chunk.
class McapWriter {
 public:
  using ChannelId = std::uint16_t;

  /// Throws InputError when the file cannot be made.
  explicit McapWriter(const std::filesystem::path& path);
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// `definition`: the ROS 2 message definition with all that it uses.
  ChannelId add_channel(const std::string& topic, const std::string& type, const std::string& definition);

  void write(ChannelId channel, Time log_time, std::string_view cdr);

  /// Writes what is left, and the summary.
  void close();

 private:
  struct ChunkIndex;

  void put(std::string_view bytes);
  void flush_chunk();
  void write_summary();

  std::filesystem::path path_;
  std::ofstream file_;
  std::uint64_t offset_ = 0;
  bool is_closed_ = false;

  std::vector<std::string> schema_types_;
  McapBytes schemas_, channels_;  ///< records, for the summary
  std::vector<std::uint32_t> sequence_;        ///< [channel - 1]
  std::vector<std::uint64_t> message_count_;   ///< [channel - 1]
  std::uint64_t first_time_ = 0, last_time_ = 0;

  McapBytes chunk_;
  std::uint64_t chunk_start_ = 0, chunk_end_ = 0;
  std::map<ChannelId, std::vector<std::pair<std::uint64_t, std::uint64_t>>> chunk_index_;
  std::vector<ChunkIndex> chunks_;
};

}  // namespace patrol::io
