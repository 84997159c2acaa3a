#include "io/mcap_writer.h"

#include <algorithm>

#include <zlib.h>
#include <zstd.h>

#include "core/error.h"
#include "io/mcap_format.h"

namespace patrol::io {
namespace {

constexpr std::size_t kChunkBytes = 1 << 20;
constexpr std::uint64_t kChunkNanoseconds = 1'000'000'000;
constexpr int kZstdLevel = 1;

std::string compressed(const std::string& bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), kZstdLevel);
  if (ZSTD_isError(size) != 0) throw std::runtime_error(std::string("zstd: ") + ZSTD_getErrorName(size));
  out.resize(size);
  return out;
}

std::uint32_t crc_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

}  // namespace

struct McapWriter::ChunkIndex {
  std::uint64_t start_time, end_time, offset, length, index_length, compressed_size, uncompressed_size;
  std::vector<std::pair<ChannelId, std::uint64_t>> message_index_offsets;
};

void McapBytes::text(std::string_view text) {
  number(static_cast<std::uint32_t>(text.size()));
  bytes_.append(text);
}

void McapBytes::record(std::uint8_t opcode, const McapBytes& content) {
  number(opcode);
  number(static_cast<std::uint64_t>(content.size()));
  raw(content.bytes());
}

McapWriter::McapWriter(const std::filesystem::path& path) : path_(path), file_(path, std::ios::binary | std::ios::trunc) {
  if (!file_) throw InputError(path.string() + ": cannot be written");
  put(mcap::kMagic);
  McapBytes header, record;
  header.text("ros2");
  header.text("patrol");
  record.record(mcap::kHeader, header);
  put(record.bytes());
}

McapWriter::~McapWriter() = default;

void McapWriter::put(std::string_view bytes) {
  file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file_) throw std::runtime_error(path_.string() + ": writing failed (disk full?)");
  offset_ += bytes.size();
}

McapWriter::ChannelId McapWriter::add_channel(const std::string& topic, const std::string& type, const std::string& definition) {
  auto known = std::find(schema_types_.begin(), schema_types_.end(), type);
  if (known == schema_types_.end()) {
    known = schema_types_.insert(schema_types_.end(), type);
    McapBytes schema;
    schema.number(static_cast<std::uint16_t>(schema_types_.size()));
    schema.text(type);
    schema.text("ros2msg");
    schema.text(definition);
    schemas_.record(mcap::kSchema, schema);
    chunk_.record(mcap::kSchema, schema);
  }
  sequence_.push_back(0);
  message_count_.push_back(0);
  const auto id = static_cast<ChannelId>(sequence_.size());
  McapBytes channel;
  channel.number(id);
  channel.number(static_cast<std::uint16_t>(known - schema_types_.begin() + 1));
  channel.text(topic);
  channel.text("cdr");
  channel.number(std::uint32_t{0});  // no metadata
  channels_.record(mcap::kChannel, channel);
  chunk_.record(mcap::kChannel, channel);
  return id;
}

void McapWriter::write(ChannelId channel, Time log_time, std::string_view cdr) {
  const auto time = static_cast<std::uint64_t>(log_time.count());
  if (chunk_.size() > kChunkBytes || (!chunk_index_.empty() && time > chunk_start_ + kChunkNanoseconds)) flush_chunk();
  if (chunk_index_.empty()) chunk_start_ = chunk_end_ = time;
  chunk_start_ = std::min(chunk_start_, time);
  chunk_end_ = std::max(chunk_end_, time);
  chunk_index_[channel].emplace_back(time, chunk_.size());

  McapBytes message;
  message.number(channel);
  message.number(sequence_[channel - 1u]++);
  message.number(time);
  message.number(time);
  message.raw(cdr);
  chunk_.record(mcap::kMessage, message);

  const bool is_first = std::all_of(message_count_.begin(), message_count_.end(), [](std::uint64_t n) { return n == 0; });
  first_time_ = is_first ? time : std::min(first_time_, time);
  last_time_ = std::max(last_time_, time);
  ++message_count_[channel - 1u];
}

void McapWriter::flush_chunk() {
  if (chunk_.size() == 0) return;
  const std::string packed = compressed(chunk_.bytes());
  McapBytes content, record;
  content.number(chunk_start_);
  content.number(chunk_end_);
  content.number(static_cast<std::uint64_t>(chunk_.size()));
  content.number(crc_of(chunk_.bytes()));
  content.text("zstd");
  content.number(static_cast<std::uint64_t>(packed.size()));
  content.raw(packed);
  record.record(mcap::kChunk, content);
  ChunkIndex index{.start_time = chunk_start_, .end_time = chunk_end_, .offset = offset_, .length = record.size(),
                   .index_length = 0, .compressed_size = packed.size(), .uncompressed_size = chunk_.size(),
                   .message_index_offsets = {}};
  put(record.bytes());

  const std::uint64_t index_start = offset_;
  for (const auto& [channel, entries] : chunk_index_) {
    index.message_index_offsets.emplace_back(channel, offset_);
    McapBytes list, index_record;
    list.number(channel);
    list.number(static_cast<std::uint32_t>(16 * entries.size()));
    for (const auto& [time, place] : entries) {
      list.number(time);
      list.number(place);
    }
    index_record.record(mcap::kMessageIndex, list);
    put(index_record.bytes());
  }
  index.index_length = offset_ - index_start;
  chunks_.push_back(std::move(index));
  file_.flush();
  chunk_.clear();
  chunk_index_.clear();
}

void McapWriter::close() {
  if (is_closed_) return;
  is_closed_ = true;
  flush_chunk();
  McapBytes end, record;
  end.number(std::uint32_t{0});  // no checksum of the data section: each chunk has its own
  record.record(mcap::kDataEnd, end);
  put(record.bytes());
  write_summary();
  put(mcap::kMagic);
  file_.close();
  if (!file_) throw std::runtime_error(path_.string() + ": closing failed (disk full?)");
}

void McapWriter::write_summary() {
  McapBytes statistics_content, statistics, indexes;
  std::uint64_t messages = 0;
  for (const std::uint64_t count : message_count_) messages += count;
  statistics_content.number(messages);
  statistics_content.number(static_cast<std::uint16_t>(schema_types_.size()));
  statistics_content.number(static_cast<std::uint32_t>(sequence_.size()));
  statistics_content.number(std::uint32_t{0});  // attachments
  statistics_content.number(std::uint32_t{0});  // metadata
  statistics_content.number(static_cast<std::uint32_t>(chunks_.size()));
  statistics_content.number(first_time_);
  statistics_content.number(last_time_);
  statistics_content.number(static_cast<std::uint32_t>(10 * message_count_.size()));
  for (std::size_t i = 0; i < message_count_.size(); ++i) {
    statistics_content.number(static_cast<std::uint16_t>(i + 1));
    statistics_content.number(message_count_[i]);
  }
  statistics.record(mcap::kStatistics, statistics_content);
  for (const ChunkIndex& chunk : chunks_) {
    McapBytes content;
    content.number(chunk.start_time);
    content.number(chunk.end_time);
    content.number(chunk.offset);
    content.number(chunk.length);
    content.number(static_cast<std::uint32_t>(10 * chunk.message_index_offsets.size()));
    for (const auto& [channel, offset] : chunk.message_index_offsets) {
      content.number(channel);
      content.number(offset);
    }
    content.number(chunk.index_length);
    content.text("zstd");
    content.number(chunk.compressed_size);
    content.number(chunk.uncompressed_size);
    indexes.record(mcap::kChunkIndex, content);
  }

  const std::uint64_t summary_start = offset_;
  McapBytes summary, offsets;
  const std::pair<std::uint8_t, const McapBytes*> groups[] = {{mcap::kSchema, &schemas_}, {mcap::kChannel, &channels_},
                                                              {mcap::kStatistics, &statistics}, {mcap::kChunkIndex, &indexes}};
  for (const auto& [opcode, group] : groups) {
    if (group->size() == 0) continue;
    McapBytes content;
    content.number(opcode);
    content.number(summary_start + summary.size());
    content.number(static_cast<std::uint64_t>(group->size()));
    offsets.record(mcap::kSummaryOffset, content);
    summary.raw(group->bytes());
  }
  const std::uint64_t offsets_start = summary_start + summary.size();
  summary.raw(offsets.bytes());

  // The summary's checksum covers it and the footer up to the checksum itself.
  McapBytes footer_head;
  footer_head.number(static_cast<std::uint8_t>(mcap::kFooter));
  footer_head.number(std::uint64_t{20});
  footer_head.number(summary_start);
  footer_head.number(offsets_start);
  summary.raw(footer_head.bytes());
  summary.number(crc_of(summary.bytes()));
  put(summary.bytes());
}

}  // namespace patrol::io
