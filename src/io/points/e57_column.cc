#include "io/points/e57_column.h"

#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "io/points/little_endian.h"

namespace patrol::io {
namespace {

constexpr std::size_t kSectionBytes = 32, kPacketHeaderBytes = 6;
constexpr std::uint8_t kVectorSection = 1;
enum PacketType : std::uint8_t { kIndexPacket = 0, kDataPacket = 1, kEmptyPacket = 2 };

/// Appends the buffers of a data packet to the columns. Returns false if the packet is invalid.
bool append_packet(std::string_view packet, std::vector<E57Column>& columns) {
  if (packet.size() < kPacketHeaderBytes || little_endian<std::uint16_t>(packet, 4) != columns.size()) return false;
  std::size_t begin = kPacketHeaderBytes + 2 * columns.size();
  if (begin > packet.size()) return false;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto size = little_endian<std::uint16_t>(packet, kPacketHeaderBytes + 2 * i);
    if (size > packet.size() - begin) return false;
    if (columns[i].is_needed) columns[i].bytes += packet.substr(begin, size);
    begin += size;
  }
  return true;
}

}  // namespace

bool E57Column::is_complete(std::uint64_t num_records) const {
  return bits == 0 || num_records <= 8 * bytes.size() / bits;
}

double E57Column::number(std::size_t record) const {
  if (type == E57Type::kFloat32) return double{little_endian<float>(bytes, 4 * record)};
  if (type == E57Type::kFloat64) return little_endian<double>(bytes, 8 * record);
  std::uint64_t above_minimum = 0;
  if (bits > 0) {
    const std::size_t first = record * bits / 8, shift = record * bits % 8;
    std::memcpy(&above_minimum, bytes.data() + first, std::min(sizeof above_minimum, bytes.size() - first));
    above_minimum >>= shift;
    if (shift + bits > 64) above_minimum |= std::uint64_t{static_cast<unsigned char>(bytes[first + 8])} << (64 - shift);
    if (bits < 64) above_minimum &= (std::uint64_t{1} << bits) - 1;
  }
  const auto integer = static_cast<std::int64_t>(static_cast<std::uint64_t>(minimum) + above_minimum);
  return scale * static_cast<double>(integer) + offset;
}

void read_e57_columns(const E57File& file, std::uint64_t section_offset, std::uint64_t num_records,
                      std::string_view path, std::vector<E57Column>& columns) {
  const std::string_view section = file.from(section_offset, path);
  if (section.size() < kSectionBytes || little_endian<std::uint8_t>(section, 0) != kVectorSection)
    file.refuse(path, fmt::format("no binary section begins at byte {}", section_offset));
  std::string_view rest = file.from(little_endian<std::uint64_t>(section, 16), path);
  const auto is_complete = [&](const E57Column& column) {
    return !column.is_needed || column.is_complete(num_records);
  };
  while (!std::ranges::all_of(columns, is_complete)) {
    const std::size_t size =
        rest.size() < kPacketHeaderBytes ? 0 : std::size_t{little_endian<std::uint16_t>(rest, 2)} + 1;
    if (size == 0 || size > rest.size()) file.refuse(path, fmt::format("ends too early for {} points", num_records));
    const auto type = little_endian<std::uint8_t>(rest, 0);
    const bool is_valid = type == kDataPacket ? append_packet(rest.substr(0, size), columns)
                                              : type == kIndexPacket || type == kEmptyPacket;
    if (!is_valid) file.refuse(path, "has an invalid data packet");
    rest.remove_prefix(size);
  }
}

}  // namespace patrol::io
