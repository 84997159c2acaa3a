#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/background_worker.h"
#include "core/time.h"
#include "io/mcap/mcap_format.h"

struct ZSTD_CCtx_s;

namespace patrol::io {

/// Writer of MCAP files: profile ros2, schemas ros2msg, messages cdr, zstd-compressed chunks, a summary with indexes,
/// and checksums throughout. The same calls produce the same bytes.
///
/// Each chunk (1 MB or one second) is written when it is complete, by a thread that compresses it: after a crash the
/// file is readable up to the last complete chunk. Without `close` the file has no summary, by which readers recognize
/// truncation. An error of writing is thrown by a later call, as OutputError (output_error.h).
class McapWriter {
 public:
  using ChannelId = std::uint16_t;

  /// Creates the file. Throws InputError if this fails.
  explicit McapWriter(const std::filesystem::path& path);
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// Adds a channel. Channels of equal type and definition share a schema. `definition`: ROS 2 message definition,
  /// including all types that it uses.
  ChannelId add_channel(const std::string& topic, const std::string& type, const std::string& definition);

  void write(ChannelId channel, Time log_time, std::string_view cdr);

  /// Writes the remaining messages and the summary. Throws OutputError if the disk is full.
  void close();

 private:
  struct ChunkIndex;
  struct IndexEntry {
    std::uint64_t log_time, offset_in_chunk;
  };
  /// Messages that are written together.
  struct Chunk {
    mcap::RecordWriter records;
    std::uint64_t start = 0, end = 0;  ///< first and last log time
    std::map<ChannelId, std::vector<IndexEntry>> index;
  };

  void put(std::string_view bytes);
  void check_file() const;
  void begin_chunk(std::uint64_t log_time);
  void flush_chunk();
  void write_chunk(const Chunk& chunk);
  void write_message_indexes(const Chunk& chunk, ChunkIndex& index);
  void write_summary();
  mcap::RecordWriter statistics() const;
  mcap::RecordWriter chunk_indexes() const;

  std::filesystem::path path_;
  std::ofstream file_;
  std::uint64_t offset_ = 0;  ///< position of the next byte
  std::uint32_t crc_ = 0;     ///< checksum of all bytes written
  bool is_closed_ = false;
  std::unique_ptr<ZSTD_CCtx_s, std::size_t (*)(ZSTD_CCtx_s*)> compressor_;
  std::string packed_;

  std::map<std::pair<std::string, std::string>, std::uint16_t> schemas_by_type_;  ///< ids, by type and definition
  mcap::RecordWriter schemas_, channels_;                                         ///< records for the summary
  std::vector<std::uint32_t> message_count_;                                      ///< [channel id - 1]
  std::uint64_t total_count_ = 0;
  std::uint64_t first_time_ = 0, last_time_ = 0;

  Chunk chunk_;  ///< chunk that is not yet complete
  std::vector<ChunkIndex> chunks_;
  BackgroundWorker worker_{true};  ///< writes complete chunks; until it is done, the file is its own
  BackgroundWorker::Ticket written_ = 0;
};

}  // namespace patrol::io
