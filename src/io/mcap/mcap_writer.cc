#include "io/mcap/mcap_writer.h"

#include <algorithm>

#include <zlib.h>
#include <zstd.h>

#include "core/error.h"
#include "io/files/output_error.h"

namespace patrol::io {
namespace {

constexpr std::size_t kChunkBytes = 1 << 20;
constexpr std::uint64_t kChunkNanoseconds = 1'000'000'000;
constexpr int kZstdLevel = 1;
constexpr const char* kCompression = "zstd";

std::uint32_t crc_of(std::string_view bytes, std::uint32_t before = 0) {
  return static_cast<std::uint32_t>(
      crc32(before, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

}  // namespace

struct McapWriter::ChunkIndex {
  std::uint64_t start_time, end_time, offset, length, index_length, compressed_size, uncompressed_size;
  std::vector<std::pair<ChannelId, std::uint64_t>> message_index_offsets;
};

McapWriter::McapWriter(const std::filesystem::path& path)
    : path_(path), file_(path, std::ios::binary | std::ios::trunc), compressor_(ZSTD_createCCtx(), &ZSTD_freeCCtx) {
  if (!file_) throw InputError(path.string() + ": cannot be written");
  mcap::RecordWriter start;
  mcap::write_start(start);
  put(start.view());
}

// After an error of the program the last messages before it are needed: write the open chunk.
McapWriter::~McapWriter() {
  try {
    if (!is_closed_) flush_chunk();
    worker_.wait(written_);
  } catch (const std::exception&) {}
}

void McapWriter::put(std::string_view bytes) {
  file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  check_file();
  offset_ += bytes.size();
  crc_ = crc_of(bytes, crc_);
}

void McapWriter::check_file() const {
  if (!file_) throw OutputError(path_.string() + ": writing failed (disk full?)");
}

McapWriter::ChannelId McapWriter::add_channel(const std::string& topic, const std::string& type,
                                              const std::string& definition) {
  const auto [known, is_new] =
      schemas_by_type_.emplace(std::pair(type, definition), static_cast<std::uint16_t>(schemas_by_type_.size() + 1));
  mcap::RecordWriter schema, channel;
  if (is_new) mcap::write_schema(schema, known->second, type, definition);
  message_count_.push_back(0);
  const auto id = static_cast<ChannelId>(message_count_.size());
  mcap::write_channel(channel, id, known->second, topic);
  schemas_.raw(schema.view());
  channels_.raw(channel.view());
  chunk_.records.raw(schema.view());
  chunk_.records.raw(channel.view());
  return id;
}

void McapWriter::write(ChannelId channel, Time log_time, std::string_view cdr) {
  const auto time = static_cast<std::uint64_t>(log_time.count());
  begin_chunk(time);
  mcap::RecordWriter& records = chunk_.records;
  chunk_.index[channel].push_back({.log_time = time, .offset_in_chunk = records.size()});
  mcap::write_message(records, channel, message_count_[channel - 1u]++, time, cdr);

  first_time_ = total_count_ == 0 ? time : std::min(first_time_, time);
  last_time_ = std::max(last_time_, time);
  ++total_count_;
}

void McapWriter::begin_chunk(std::uint64_t log_time) {
  const bool is_full = chunk_.records.size() > kChunkBytes;
  const bool is_old = !chunk_.index.empty() && log_time > chunk_.start + kChunkNanoseconds;
  if (is_full || is_old) flush_chunk();
  if (chunk_.index.empty()) chunk_.start = chunk_.end = log_time;
  chunk_.start = std::min(chunk_.start, log_time);
  chunk_.end = std::max(chunk_.end, log_time);
}

/// Gives the chunk to the worker, after the one before is written.
void McapWriter::flush_chunk() {
  if (chunk_.records.is_empty()) return;
  worker_.wait(written_);
  written_ = worker_.submit([this, chunk = std::exchange(chunk_, {})] { write_chunk(chunk); });
}

void McapWriter::write_chunk(const Chunk& chunk) {
  const std::string_view records = chunk.records.view();
  packed_.resize(ZSTD_compressBound(records.size()));
  const std::size_t packed_size =
      ZSTD_compressCCtx(compressor_.get(), packed_.data(), packed_.size(), records.data(), records.size(), kZstdLevel);
  if (ZSTD_isError(packed_size) != 0) throw std::runtime_error(std::string("zstd: ") + ZSTD_getErrorName(packed_size));

  mcap::RecordWriter fields, head;
  fields.number(chunk.start);
  fields.number(chunk.end);
  fields.number(std::uint64_t{records.size()});
  fields.number(crc_of(records));
  fields.text(kCompression);
  fields.number(std::uint64_t{packed_size});
  head.record_head(mcap::kChunk, fields.size() + packed_size);
  head.raw(fields.view());
  ChunkIndex index{.start_time = chunk.start,
                   .end_time = chunk.end,
                   .offset = offset_,
                   .length = head.size() + packed_size,
                   .index_length = 0,
                   .compressed_size = packed_size,
                   .uncompressed_size = records.size(),
                   .message_index_offsets = {}};
  put(head.view());
  put(std::string_view(packed_).substr(0, packed_size));
  write_message_indexes(chunk, index);
  chunks_.push_back(std::move(index));
  file_.flush();
  check_file();
}

void McapWriter::write_message_indexes(const Chunk& chunk, ChunkIndex& index) {
  const std::uint64_t start = offset_;
  for (const auto& [channel, entries] : chunk.index) {
    index.message_index_offsets.emplace_back(channel, offset_);
    mcap::RecordWriter content, record;
    content.number(channel);
    content.number(static_cast<std::uint32_t>(sizeof(IndexEntry) * entries.size()));
    for (const IndexEntry& entry : entries) {
      content.number(entry.log_time);
      content.number(entry.offset_in_chunk);
    }
    record.record(mcap::kMessageIndex, content);
    put(record.view());
  }
  index.index_length = offset_ - start;
}

void McapWriter::close() {
  if (is_closed_) return;
  flush_chunk();
  worker_.wait(written_);
  is_closed_ = true;
  mcap::RecordWriter data_crc, record;
  data_crc.number(crc_);
  record.record(mcap::kDataEnd, data_crc);
  put(record.view());
  write_summary();
  put(mcap::kMagic);
  file_.close();
  check_file();
}

mcap::RecordWriter McapWriter::statistics() const {
  mcap::RecordWriter content, record;
  content.number(total_count_);
  content.number(static_cast<std::uint16_t>(schemas_by_type_.size()));
  content.number(static_cast<std::uint32_t>(message_count_.size()));
  content.number(std::uint32_t{0});  // attachments
  content.number(std::uint32_t{0});  // metadata
  content.number(static_cast<std::uint32_t>(chunks_.size()));
  content.number(first_time_);
  content.number(last_time_);
  content.number(static_cast<std::uint32_t>((sizeof(ChannelId) + sizeof(std::uint64_t)) * message_count_.size()));
  for (std::size_t i = 0; i < message_count_.size(); ++i) {
    content.number(static_cast<ChannelId>(i + 1));
    content.number(std::uint64_t{message_count_[i]});
  }
  record.record(mcap::kStatistics, content);
  return record;
}

mcap::RecordWriter McapWriter::chunk_indexes() const {
  mcap::RecordWriter records;
  for (const ChunkIndex& chunk : chunks_) {
    mcap::RecordWriter content;
    content.number(chunk.start_time);
    content.number(chunk.end_time);
    content.number(chunk.offset);
    content.number(chunk.length);
    content.number(
        static_cast<std::uint32_t>((sizeof(ChannelId) + sizeof(std::uint64_t)) * chunk.message_index_offsets.size()));
    for (const auto& [channel, offset] : chunk.message_index_offsets) {
      content.number(channel);
      content.number(offset);
    }
    content.number(chunk.index_length);
    content.text(kCompression);
    content.number(chunk.compressed_size);
    content.number(chunk.uncompressed_size);
    records.record(mcap::kChunkIndex, content);
  }
  return records;
}

void McapWriter::write_summary() {
  const std::uint64_t start = offset_;
  const std::pair<mcap::Opcode, mcap::RecordWriter> groups[] = {{mcap::kSchema, schemas_},
                                                                {mcap::kChannel, channels_},
                                                                {mcap::kStatistics, statistics()},
                                                                {mcap::kChunkIndex, chunk_indexes()}};
  mcap::RecordWriter summary, offsets;
  for (const auto& [opcode, group] : groups) {
    if (group.is_empty()) continue;
    mcap::RecordWriter content;
    content.number(static_cast<std::uint8_t>(opcode));
    content.number(start + summary.size());
    content.number(std::uint64_t{group.size()});
    offsets.record(mcap::kSummaryOffset, content);
    summary.raw(group.view());
  }
  const std::uint64_t offsets_start = start + summary.size();
  summary.raw(offsets.view());

  // The checksum covers the summary and the footer up to the checksum field.
  summary.record_head(mcap::kFooter, mcap::kFooterSize - mcap::kRecordHeadSize);
  summary.number(start);
  summary.number(offsets_start);
  summary.number(crc_of(summary.view()));
  put(summary.view());
}

}  // namespace patrol::io
