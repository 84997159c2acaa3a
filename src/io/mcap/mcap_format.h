#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

/// Elements of the MCAP format (mcap.dev/spec) used by writer and reader. A record is an opcode, the length of its
/// content (uint64) and the content. Numbers are little-endian; strings are preceded by their length (uint32).
namespace patrol::io::mcap {

static_assert(std::endian::native == std::endian::little, "numbers are copied in the byte order of the memory");

inline constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};
inline constexpr std::size_t kRecordHeadSize = 1 + 8;
inline constexpr std::size_t kFooterSize = kRecordHeadSize + 8 + 8 + 4;

enum Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0b,
  kSummaryOffset = 0x0e,
  kDataEnd = 0x0f,
};

/// Serializer of records.
class RecordWriter {
 public:
  template <typename Integer>
  void number(Integer value) {
    char raw[sizeof(Integer)];
    std::memcpy(raw, &value, sizeof(Integer));
    bytes_.append(raw, sizeof(Integer));
  }
  void text(std::string_view text) {
    number(static_cast<std::uint32_t>(text.size()));
    raw(text);
  }
  void raw(std::string_view bytes) { bytes_.append(bytes); }
  void record_head(Opcode opcode, std::uint64_t content_size) {
    number(static_cast<std::uint8_t>(opcode));
    number(content_size);
  }
  void record(Opcode opcode, const RecordWriter& content) {
    record_head(opcode, content.size());
    raw(content.view());
  }

  std::string_view view() const { return bytes_; }
  std::size_t size() const { return bytes_.size(); }
  bool is_empty() const { return bytes_.empty(); }
  void clear() { bytes_.clear(); }

 private:
  std::string bytes_;
};

/// Appends the start of a file or a stream: magic and header.
inline void write_start(RecordWriter& records) {
  RecordWriter header;
  header.text("ros2");
  header.text("patrol");
  records.raw(kMagic);
  records.record(kHeader, header);
}

/// Appends a schema. `definition`: ROS 2 message definition, including all types that it uses.
inline void write_schema(RecordWriter& records, std::uint16_t id, std::string_view type, std::string_view definition) {
  RecordWriter schema;
  schema.number(id);
  schema.text(type);
  schema.text("ros2msg");
  schema.text(definition);
  records.record(kSchema, schema);
}

/// Appends a channel without metadata.
inline void write_channel(RecordWriter& records, std::uint16_t id, std::uint16_t schema, std::string_view topic) {
  RecordWriter channel;
  channel.number(id);
  channel.number(schema);
  channel.text(topic);
  channel.text("cdr");
  channel.number(std::uint32_t{0});  // no metadata
  records.record(kChannel, channel);
}

/// Appends a message that is published at the time of its log entry, in ns.
inline void write_message(RecordWriter& records, std::uint16_t channel, std::uint32_t sequence, std::uint64_t time,
                          std::string_view cdr) {
  records.record_head(kMessage, sizeof(channel) + sizeof(sequence) + 2 * sizeof(time) + cdr.size());
  records.number(channel);
  records.number(sequence);
  records.number(time);  // log time
  records.number(time);  // publish time
  records.raw(cdr);
}

/// Bytes that violate the format. The message has no file and position; the caller adds them.
class FormatError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Parser of the content of a record. Throws FormatError if the content is too short.
class RecordReader {
 public:
  explicit RecordReader(std::string_view bytes) : bytes_(bytes) {}

  template <typename Integer>
  Integer number() {
    Integer value;
    std::memcpy(&value, take(sizeof(Integer)).data(), sizeof(Integer));
    return value;
  }
  std::string text() { return std::string(take(number<std::uint32_t>())); }
  std::string_view take(std::uint64_t size) {
    if (size > bytes_.size()) throw FormatError("a record ends too early");
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }
  std::string_view rest() { return take(bytes_.size()); }
  bool is_empty() const { return bytes_.empty(); }

 private:
  std::string_view bytes_;
};

}  // namespace patrol::io::mcap
