#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "core/time.h"
#include "io/mcap/mcap_reader.h"

namespace patrol::link {

/// Limits on records from the other side.
struct RecordLimits {
  std::size_t record_bytes = std::size_t{64} << 20;
  std::size_t num_channels = 256;
  std::size_t num_schemas = 256;
};

/// Parser of the records of one side of a connection, which arrive in pieces. A stream begins as an MCAP file does:
/// magic, then records; schemas, channels and messages count, and records of other kinds are skipped.
///
/// Throws LinkError (kInvalid) for bytes that violate the format or the limits.
class RecordParser {
 public:
  explicit RecordParser(const RecordLimits& limits = {}) : limits_(limits) {}

  /// Returns room for at least `size` further bytes, valid until the next call.
  char* prepare(std::size_t size);
  /// Adds the first `size` bytes of that room to the stream.
  void commit(std::size_t size) { end_ += size; }

  /// Returns the next message, valid until the next call of `prepare`; nullopt if its bytes have not all arrived.
  std::optional<io::McapMessage> next();

 private:
  struct Schema {
    std::string type, definition;
  };

  std::optional<io::McapMessage> read_record(std::uint8_t opcode, std::string_view content);
  void add_schema(std::string_view content);
  void add_channel(std::string_view content);
  io::McapMessage message_of(std::string_view content) const;

  RecordLimits limits_;
  std::string buffer_;
  std::size_t begin_ = 0, end_ = 0;  ///< unread part of the buffer
  bool has_magic_ = false;
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, io::McapChannel> channels_;
};

}  // namespace patrol::link
