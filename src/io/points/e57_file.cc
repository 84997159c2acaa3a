#include "io/points/e57_file.h"

#include <bit>

#include <boost/crc.hpp>
#include <fmt/format.h>

#include "core/error.h"
#include "io/points/file_text.h"
#include "io/points/little_endian.h"

namespace patrol::io {
namespace {

constexpr std::size_t kE57HeaderBytes = 48;
constexpr std::uint64_t kChecksumBytes = 4;
constexpr std::uint64_t kMinPageBytes = 64, kMaxPageBytes = std::uint64_t{1} << 24;

/// Returns the CRC-32C of the bytes. Pages store it with the highest byte first.
std::uint32_t checksum(std::string_view bytes) {
  boost::crc_optimal<32, 0x1EDC6F41, 0xFFFFFFFF, 0xFFFFFFFF, true, true> crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

std::uint32_t big_endian32(std::string_view bytes) {
  std::uint32_t number = 0;
  for (const char byte : bytes) number = (number << 8) | static_cast<unsigned char>(byte);
  return number;
}

}  // namespace

E57File::E57File(const std::filesystem::path& file) : file_(file.string()) {
  const FileText text(file);
  const std::string_view pages = text.rest();
  const auto refuse_file = [&](const std::string& reason) { throw InputError(fmt::format("{}: {}", file_, reason)); };
  if (pages.size() < kE57HeaderBytes || !pages.starts_with("ASTM-E57")) refuse_file("is not an E57 file");
  const auto major = little_endian<std::uint32_t>(pages, 8);
  if (major != 1)
    refuse_file(
        fmt::format("E57 version {}.{} is not supported (known: 1.0)", major, little_endian<std::uint32_t>(pages, 12)));
  const auto size = little_endian<std::uint64_t>(pages, 16);
  page_bytes_ = little_endian<std::uint64_t>(pages, 40);
  if (!std::has_single_bit(page_bytes_) || page_bytes_ < kMinPageBytes || page_bytes_ > kMaxPageBytes)
    refuse_file(fmt::format("pages of {} bytes are not supported", page_bytes_));
  if (size != pages.size() || size % page_bytes_ != 0)
    refuse_file(fmt::format("has {} bytes, its header gives {} in pages of {}", pages.size(), size, page_bytes_));
  bytes_.reserve(pages.size());
  for (std::size_t begin = 0; begin < pages.size(); begin += page_bytes_) {
    const std::string_view payload = pages.substr(begin, page_bytes_ - kChecksumBytes);
    if (checksum(payload) != big_endian32(pages.substr(begin + payload.size(), kChecksumBytes)))
      refuse_file(fmt::format("is damaged: the checksum of the page at byte {} is wrong", begin));
    bytes_ += payload;
  }
  const auto xml_bytes = little_endian<std::uint64_t>(pages, 32);
  xml_ = from(little_endian<std::uint64_t>(pages, 24), "XML section");
  if (xml_bytes > xml_.size()) refuse("XML section", "ends after the file");
  xml_ = xml_.substr(0, xml_bytes);
}

std::string_view E57File::from(std::uint64_t physical_offset, std::string_view path) const {
  const std::uint64_t page = physical_offset / page_bytes_;
  const std::uint64_t logical_offset = physical_offset - kChecksumBytes * page;
  if (physical_offset % page_bytes_ >= page_bytes_ - kChecksumBytes || logical_offset >= bytes_.size())
    refuse(path, fmt::format("offset {} is not in a page of the file", physical_offset));
  return std::string_view(bytes_).substr(logical_offset);
}

void E57File::refuse(std::string_view path, std::string_view reason) const {
  throw InputError(fmt::format("{}: {}: {}", file_, path, reason));
}

}  // namespace patrol::io
