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
    if (selection_.order != McapOrder::kLogTime) fail(format_error.what());
    channels_.clear();  // damaged: the file is read sequentially
    unwanted_chunks_.clear();
  }
  if (selection_.order == McapOrder::kLogTime) open_by_time();
  offset_ = mcap::kMagic.size();
}

double McapReader::progress() const {
  if (is_by_time_) {
    const auto num_chunks = static_cast<double>(chunks_by_time_.size());
    return num_chunks > 0.0 ? static_cast<double>(num_opened_) / num_chunks : 1.0;
  }
  return size_ > 0 ? static_cast<double>(offset_) / static_cast<double>(size_) : 1.0;
}

std::optional<std::set<std::string>> McapReader::topics() const {
  if (summary_channels_.empty()) return std::nullopt;
  return summary_channels_;
}

/// Prepares reading by log time. Without a usable summary, or with messages outside of chunks, nothing of the summary
/// is used.
void McapReader::open_by_time() {
  std::optional<std::vector<ChunkEntry>> chunks = channels_.empty() ? std::nullopt : find_chunks();
  is_by_time_ = chunks.has_value();
  if (!chunks) {
    channels_.clear();
    unwanted_chunks_.clear();
    return;
  }
  chunks_by_time_ = std::move(*chunks);
  std::erase_if(chunks_by_time_, [&](const ChunkEntry& chunk) { return unwanted_chunks_.contains(chunk.offset); });
  std::ranges::stable_sort(chunks_by_time_, {}, &ChunkEntry::start);
}

/// Returns the chunks by the heads of all records; nullopt if a message is outside of them or a record is damaged.
std::optional<std::vector<McapReader::ChunkEntry>> McapReader::find_chunks() {
  std::vector<ChunkEntry> chunks;
  for (std::uint64_t offset = mcap::kMagic.size(); offset + mcap::kRecordHeadSize <= size_;) {
    const std::string head_bytes = read_bytes(offset, mcap::kRecordHeadSize);
    mcap::RecordReader head(head_bytes);
    const auto opcode = head.number<std::uint8_t>();
    const auto length = head.number<std::uint64_t>();
    const std::uint64_t start = offset + mcap::kRecordHeadSize;
    if (opcode == mcap::kDataEnd || opcode == mcap::kFooter) return chunks;
    if (opcode == 0 || opcode == mcap::kMessage || length > size_ - start) return std::nullopt;
    if (opcode == mcap::kChunk) {
      if (length < sizeof(std::uint64_t) || length > kMaxRecordBytes) return std::nullopt;
      const std::string time_bytes = read_bytes(start, sizeof(std::uint64_t));
      mcap::RecordReader time(time_bytes);
      chunks.push_back({.start = to_time(time.number<std::uint64_t>()), .offset = offset, .length = length});
    }
    offset = start + length;
  }
  return std::nullopt;
}

/// Unpacks a chunk and sorts its messages.
void McapReader::open_chunk(const ChunkEntry& entry) {
  record_start_ = entry.offset;
  const std::string record = read_bytes(entry.offset + mcap::kRecordHeadSize, entry.length);
  OpenChunk chunk{.bytes = unpack_chunk(mcap::RecordReader(record)), .messages = {}};
  // A short string has its bytes in itself: views are taken where the chunk stays.
  const auto place = open_chunks_.emplace(std::pair(entry.start, entry.offset), std::move(chunk)).first;
  OpenChunks::node_type node = open_chunks_.extract(place);
  OpenChunk& opened = node.mapped();
  mcap::RecordReader records(opened.bytes);
  while (!records.is_empty()) {
    const auto opcode = records.number<std::uint8_t>();
    const std::string_view bytes = records.take(records.number<std::uint64_t>());
    mcap::RecordReader content(bytes);
    if (opcode == mcap::kSchema) add_schema(content);
    if (opcode == mcap::kChannel) add_channel(content);
    if (opcode != mcap::kMessage) continue;
    content.take(sizeof(std::uint16_t) + sizeof(std::uint32_t));  // channel and sequence
    opened.messages.emplace_back(to_time(content.number<std::uint64_t>()), bytes);
  }
  if (opened.messages.empty()) return;
  std::ranges::stable_sort(opened.messages, {}, [](const auto& message) { return message.first; });
  node.key().first = opened.messages.front().first;
  open_chunks_.insert(std::move(node));
}

std::optional<McapMessage> McapReader::next_by_time() {
  last_chunk_ = {};
  while (true) {
    const bool has_closed = num_opened_ < chunks_by_time_.size();
    if (has_closed &&
        (open_chunks_.empty() || chunks_by_time_[num_opened_].start <= open_chunks_.begin()->first.first)) {
      open_chunk(chunks_by_time_[num_opened_++]);
      continue;
    }
    if (open_chunks_.empty()) return std::nullopt;
    OpenChunks::node_type node = open_chunks_.extract(open_chunks_.begin());
    OpenChunk& chunk = node.mapped();
    record_start_ = node.key().second;
    const std::string_view content = chunk.messages[chunk.next++].second;
    if (chunk.next < chunk.messages.size()) {
      node.key().first = chunk.messages[chunk.next].first;
      open_chunks_.insert(std::move(node));
    } else {
      last_chunk_ = std::move(node);
    }
    if (const auto message = read_message(mcap::RecordReader(content))) return message;
  }
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
  if (summary_start > 0) read_summary(summary_start, footer_start_);
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
  for (const auto& [id, channel] : channels_) summary_channels_.insert(channel.topic);
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

std::optional<McapMessage> McapReader::next_in_file() {
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
}

std::optional<McapMessage> McapReader::next() {
  try {
    return is_by_time_ ? next_by_time() : next_in_file();
  } catch (const mcap::FormatError& format_error) {
    rest_of_chunk_ = {};
    std::erase_if(open_chunks_, [&](const auto& chunk) { return chunk.first.second == record_start_; });
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

Time last_message_time(const std::filesystem::path& path) {
  std::optional<Time> last = McapReader(path).last_time();
  if (!last)
    read_mcap(path, [&](const McapMessage& message) { last = std::max(last.value_or(Time::min()), message.log_time); });
  if (!last) throw InputError(path.string() + ": has no messages");
  return *last;
}

}  // namespace patrol::io
