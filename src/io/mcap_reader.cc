#include "io/mcap_reader.h"

#include <fstream>
#include <map>
#include <optional>

#include <fmt/format.h>
#include <zlib.h>
#include <zstd.h>

#include "core/error.h"
#include "io/mcap_format.h"

namespace patrol::io {
namespace {

/// Reads little-endian fields of one record; running past its end means damage.
class RecordReader {
 public:
  explicit RecordReader(std::string_view bytes) : bytes_(bytes) {}

  template <typename Integer>
  Integer number() {
    const std::string_view raw = take(sizeof(Integer));
    Integer value = 0;
    for (std::size_t i = 0; i < sizeof(Integer); ++i) {
      value = static_cast<Integer>(value | (static_cast<Integer>(static_cast<unsigned char>(raw[i])) << (8 * i)));
    }
    return value;
  }
  std::string text() { return std::string(take(number<std::uint32_t>())); }
  std::string_view take(std::size_t size) {
    if (size > bytes_.size()) throw std::out_of_range("a record ends too early");
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }
  std::string_view rest() { return take(bytes_.size()); }
  bool is_empty() const { return bytes_.empty(); }

 private:
  std::string_view bytes_;
};

class McapFile {
 public:
  McapFile(const std::filesystem::path& path, const std::function<void(const McapMessage&)>& handle)
      : path_(path), file_(path, std::ios::binary), handle_(handle) {
    if (!file_) throw InputError(path.string() + ": cannot be read");
  }

  bool read() {
    std::string magic(mcap::kMagic.size(), '\0');
    file_.read(magic.data(), static_cast<std::streamsize>(magic.size()));
    if (!file_ || magic != mcap::kMagic) throw InputError(path_.string() + ": is not an MCAP file");
    try {
      while (const std::optional<std::uint8_t> opcode = next_record()) {
        if (*opcode == mcap::kDataEnd) return true;
        handle_record(*opcode, record_);
      }
    } catch (const std::out_of_range& error) {
      throw InputError(fmt::format("{}: byte {}: {}", path_.string(), record_start_, error.what()));
    }
    return false;
  }

 private:
  /// The next whole record's opcode, its content in `record_`; none at the end or at the cut.
  std::optional<std::uint8_t> next_record() {
    record_start_ = static_cast<std::uint64_t>(file_.tellg());
    char head[9];
    if (!file_.read(head, sizeof head)) return std::nullopt;
    RecordReader reader(std::string_view(head, sizeof head));
    const auto opcode = reader.number<std::uint8_t>();
    const auto length = reader.number<std::uint64_t>();
    constexpr std::uint64_t kSane = 1ULL << 32;
    if (length > kSane) throw std::out_of_range(fmt::format("a record of {} bytes is damaged", length));
    record_.resize(length);
    if (!file_.read(record_.data(), static_cast<std::streamsize>(length))) return std::nullopt;
    return opcode;
  }

  void handle_record(std::uint8_t opcode, std::string_view content) {
    RecordReader reader(content);
    if (opcode == mcap::kSchema) {
      const auto id = reader.number<std::uint16_t>();
      schemas_[id] = reader.text();
    } else if (opcode == mcap::kChannel) {
      const auto id = reader.number<std::uint16_t>();
      const auto schema = reader.number<std::uint16_t>();
      channels_[id] = {reader.text(), schemas_[schema]};
    } else if (opcode == mcap::kMessage) {
      const auto channel = channels_.find(reader.number<std::uint16_t>());
      if (channel == channels_.end()) throw std::out_of_range("a message of an unknown channel");
      reader.number<std::uint32_t>();  // sequence
      const Time log_time{static_cast<std::int64_t>(reader.number<std::uint64_t>())};
      reader.number<std::uint64_t>();  // publish time
      handle_({channel->second.topic, channel->second.type, log_time, reader.rest()});
    } else if (opcode == mcap::kChunk) {
      handle_chunk(reader);
    }
  }

  void handle_chunk(RecordReader& reader) {
    reader.number<std::uint64_t>();
    reader.number<std::uint64_t>();
    const auto size = reader.number<std::uint64_t>();
    const auto crc = reader.number<std::uint32_t>();
    const std::string compression = reader.text();
    const std::string_view packed = reader.take(reader.number<std::uint64_t>());
    const std::string unpacked = unpack(compression, packed, size);
    const auto actual = static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(unpacked.data()), static_cast<uInt>(unpacked.size())));
    if (crc != 0 && actual != crc) throw std::out_of_range("a chunk's checksum is wrong");
    RecordReader records(unpacked);
    while (!records.is_empty()) {
      const auto opcode = records.number<std::uint8_t>();
      handle_record(opcode, records.take(records.number<std::uint64_t>()));
    }
  }

  static std::string unpack(const std::string& compression, std::string_view packed, std::uint64_t size) {
    if (compression.empty()) return std::string(packed);
    if (compression != "zstd") throw std::out_of_range("compression " + compression + " is not supported (zstd is)");
    std::string unpacked(size, '\0');
    const std::size_t got = ZSTD_decompress(unpacked.data(), unpacked.size(), packed.data(), packed.size());
    if (ZSTD_isError(got) != 0 || got != size) throw std::out_of_range("a chunk cannot be unpacked");
    return unpacked;
  }

  struct Channel {
    std::string topic, type;
  };

  std::filesystem::path path_;
  std::ifstream file_;
  const std::function<void(const McapMessage&)>& handle_;
  std::string record_;
  std::uint64_t record_start_ = 0;
  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, Channel> channels_;
};

}  // namespace

bool read_mcap(const std::filesystem::path& path, const std::function<void(const McapMessage&)>& handle) {
  return McapFile(path, handle).read();
}

}  // namespace patrol::io
