#pragma once

#include <array>
#include <cstdint>
#include <string_view>

/// Numbers of the MCAP format (mcap.dev/spec), for writer and reader.
namespace patrol::io::mcap {

inline constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};

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

}  // namespace patrol::io::mcap
