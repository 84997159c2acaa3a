#include "io/mcap/mcap_reader.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include "core/error.h"

namespace patrol::io {
namespace {

/// Maximum size of a record and of an unpacked chunk. Larger values are treated as damage, because sizes in the file
/// must not determine the memory use.
constexpr std::uint64_t kMaxRecordBytes = std::uint64_t{1} << 28;

Time to_time(std::uint64_t nanoseconds) { return Time{static_cast<std::int64_t>(nanoseconds)}; }

void expect_size(std::uint64_t size, const char* what) {
  if (size > kMaxRecordBytes) throw mcap::FormatError(fmt::format("{} of {} bytes is too large", what, size));
}

std::string unpack_zstd(std::string_view packed, std::uint64_t size) {
  std::string unpacked(size, '\0');
  const std::size_t got = ZSTD_decompress(unpacked.data(), unpacked.size(), packed.data(), packed.size());
  if (ZSTD_isError(got) != 0 || got != size) throw mcap::FormatError("chunk cannot be decompressed");
  return unpacked;
}

std::string unpack_lz4(std::string_view packed, std::uint64_t size) {
  LZ4F_dctx* context = nullptr;
  LZ4F_createDecompressionContext(&context, LZ4F_VERSION);
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> owner(context, &LZ4F_freeDecompressionContext);
  std::string unpacked(size, '\0');
  std::size_t written = 0, done = 0, hint = 1;
  while (hint != 0 && done < packed.size()) {
    std::size_t room = unpacked.size() - written, taken = packed.size() - done;
    hint = LZ4F_decompress(context, unpacked.data() + written, &room, packed.data() + done, &taken, nullptr);
    if (LZ4F_isError(hint) != 0 || (room == 0 && taken == 0)) break;
    written += room;
    done += taken;
  }
  if (hint != 0 || written != size) throw mcap::FormatError("chunk cannot be decompressed");
  return unpacked;
}

}  // namespace

McapReader::McapReader(const std::filesystem::path& path, McapSelection selection)
    : path_(path), file_(path, std::ios::binary), selection_(std::move(selection)) {
  std::error_code error;
  size_ = std::filesystem::file_size(path, error);
  if (!file_ || error) throw InputError(path.string() + ": cannot be read");
  if (size_ < mcap::kMagic.size() || read_bytes(0, mcap::kMagic.size()) != mcap::kMagic) {
    throw InputError(path.string() + ": is not an MCAP file");
  }
  try {
    find_footer();
  } catch (const mcap::FormatError& format_error) {
    fail(format_error.what());
  }
  offset_ = mcap::kMagic.size();
}

void McapReader::fail(const std::string& what) const {
  throw InputError(fmt::format("{}: byte {}: {}", path_.string(), record_start_, what));
}

std::string McapReader::read_bytes(std::uint64_t offset, std::uint64_t size) {
  std::string bytes(size, '\0');
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(offset));
  file_.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!file_) throw InputError(fmt::format("{}: byte {}: cannot be read", path_.string(), offset));
  return bytes;
}

void McapReader::find_footer() {
  const std::size_t tail_size = mcap::kFooterSize + mcap::kMagic.size();
  if (size_ < mcap::kMagic.size() + tail_size) return;
  const std::string tail = read_bytes(size_ - tail_size, tail_size);
  mcap::RecordReader footer(tail);
  const bool is_footer = footer.number<std::uint8_t>() == mcap::kFooter &&
                         footer.number<std::uint64_t>() == mcap::kFooterSize - mcap::kRecordHeadSize;
  if (!is_footer || !tail.ends_with(mcap::kMagic)) return;
  footer_start_ = size_ - tail_size;
  const auto summary_start = footer.number<std::uint64_t>();
  if (summary_start > 0 && selection_.use_summary) read_summary(summary_start, footer_start_);
}

void McapReader::read_summary(std::uint64_t start, std::uint64_t end) {
  record_start_ = start;
  if (start > end) throw mcap::FormatError("summary is outside the file");
  expect_size(end - start, "the summary");
  const std::string bytes = read_bytes(start, end - start);
  mcap::RecordReader records(bytes);
  while (!records.is_empty()) {
    const auto opcode = records.number<std::uint8_t>();
    mcap::RecordReader content(records.take(records.number<std::uint64_t>()));
    if (opcode == mcap::kSchema) add_schema(content);
    if (opcode == mcap::kChannel) add_channel(content);
    if (opcode == mcap::kChunkIndex) add_chunk(content);
    if (opcode == mcap::kStatistics) {
      content.take(8 + 2 + 4 + 4 + 4 + 4 + 8);  // counts and the time of the first message
      last_time_ = to_time(content.number<std::uint64_t>());
    }
  }
  if (channels_.empty()) unwanted_chunks_.clear();  // the channels are in the chunks: skip none
}

void McapReader::add_chunk(mcap::RecordReader content) {
  const Time start = to_time(content.number<std::uint64_t>()), end = to_time(content.number<std::uint64_t>());
  const auto offset = content.number<std::uint64_t>();
  content.number<std::uint64_t>();  // length
  mcap::RecordReader message_indexes(content.take(content.number<std::uint32_t>()));
  const bool is_indexed = !message_indexes.is_empty();
  bool has_wanted_topic = !is_indexed;
  while (!message_indexes.is_empty()) {
    const auto channel = channels_.find(message_indexes.number<std::uint16_t>());
    message_indexes.number<std::uint64_t>();
    if (channel == channels_.end() || is_wanted(channel->second.topic)) has_wanted_topic = true;
  }
  if (!has_wanted_topic || end < selection_.from || start > selection_.to) unwanted_chunks_.insert(offset);
}

void McapReader::add_schema(mcap::RecordReader content) {
  const auto id = content.number<std::uint16_t>();
  Schema& schema = schemas_[id];
  schema.type = content.text();
  schema.encoding = content.text();
  schema.definition = content.text();
}

void McapReader::add_channel(mcap::RecordReader content) {
  const auto id = content.number<std::uint16_t>();
  const auto schema = schemas_.find(content.number<std::uint16_t>());
  if (schema == schemas_.end()) throw mcap::FormatError("channel with an unknown schema");
  channels_[id] = {.topic = content.text(),
                   .type = schema->second.type,
                   .definition = schema->second.definition,
                   .schema_encoding = schema->second.encoding,
                   .message_encoding = content.text()};
}

bool McapReader::is_wanted(const std::string& topic) const {
  const std::vector<std::string>& topics = selection_.topics;
  return topics.empty() || std::find(topics.begin(), topics.end(), topic) != topics.end();
}

std::optional<McapMessage> McapReader::next() {
  try {
    while (true) {
      while (!rest_of_chunk_.empty()) {
        mcap::RecordReader records(rest_of_chunk_);
        const auto opcode = records.number<std::uint8_t>();
        const mcap::RecordReader content(records.take(records.number<std::uint64_t>()));
        rest_of_chunk_ = records.rest();
        if (opcode == mcap::kSchema) add_schema(content);
        if (opcode == mcap::kChannel) add_channel(content);
        if (opcode != mcap::kMessage) continue;
        if (const auto message = read_message(content)) return message;
      }
      if (!read_record()) return std::nullopt;
    }
  } catch (const mcap::FormatError& format_error) {
    rest_of_chunk_ = {};
    fail(format_error.what());
  }
}

/// Advances to the next record with messages and stores it in `rest_of_chunk_`; returns false at the end or truncation.
bool McapReader::read_record() {
  while (!is_at_end_) {
    record_start_ = offset_;
    if (offset_ + mcap::kRecordHeadSize > size_) break;
    const std::string head_bytes = read_bytes(offset_, mcap::kRecordHeadSize);
    mcap::RecordReader head(head_bytes);
    const auto opcode = head.number<std::uint8_t>();
    const auto length = head.number<std::uint64_t>();
    if (opcode == 0) throw mcap::FormatError("is not a record");
    const std::uint64_t start = offset_ + mcap::kRecordHeadSize;
    if (length > size_ - start) {
      if (is_complete()) throw mcap::FormatError(fmt::format("a record of {} bytes does not fit in the file", length));
      break;  // truncation
    }
    offset_ = start + length;
    if (opcode == mcap::kDataEnd || opcode == mcap::kFooter) break;
    if (opcode == mcap::kChunk && !unwanted_chunks_.contains(record_start_)) {
      expect_size(length, "a chunk");
      record_ = read_bytes(start, length);
      chunk_ = unpack_chunk(mcap::RecordReader(record_));
      rest_of_chunk_ = chunk_;
      return true;
    }
    if (opcode == mcap::kSchema || opcode == mcap::kChannel || opcode == mcap::kMessage) {
      expect_size(length, "a record");
      chunk_ = head_bytes + read_bytes(start, length);
      rest_of_chunk_ = chunk_;
      return true;
    }
  }
  is_at_end_ = true;
  return false;
}

std::optional<McapMessage> McapReader::read_message(mcap::RecordReader content) {
  const auto channel = channels_.find(content.number<std::uint16_t>());
  if (channel == channels_.end()) throw mcap::FormatError("message with an unknown channel");
  content.number<std::uint32_t>();  // sequence
  const Time log_time = to_time(content.number<std::uint64_t>());
  content.number<std::uint64_t>();  // publish time
  if (!is_wanted(channel->second.topic) || log_time < selection_.from || log_time > selection_.to) return std::nullopt;
  return McapMessage{.channel = channel->second, .log_time = log_time, .cdr = content.rest()};
}

std::string McapReader::unpack_chunk(mcap::RecordReader content) {
  content.take(8 + 8);  // the times of the first and last message
  const auto size = content.number<std::uint64_t>();
  const auto crc = content.number<std::uint32_t>();
  const std::string compression = content.text();
  const std::string_view packed = content.take(content.number<std::uint64_t>());
  expect_size(size, "a chunk");

  std::string unpacked;
  if (compression.empty()) unpacked = packed;
  else if (compression == "zstd") unpacked = unpack_zstd(packed, size);
  else if (compression == "lz4") unpacked = unpack_lz4(packed, size);
  else throw mcap::FormatError("unknown compression '" + compression + "' (known: zstd, lz4)");

  const auto actual = crc32(0, reinterpret_cast<const Bytef*>(unpacked.data()), static_cast<uInt>(unpacked.size()));
  if (crc != 0 && crc != actual) throw mcap::FormatError("wrong checksum of a chunk");
  return unpacked;
}

bool read_mcap(const std::filesystem::path& path, const std::function<void(const McapMessage&)>& handle,
               const McapSelection& selection) {
  McapReader reader(path, selection);
  while (const std::optional<McapMessage> message = reader.next()) handle(*message);
  return reader.is_complete();
}

}  // namespace patrol::io
