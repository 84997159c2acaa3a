#include "app/run/tick_digest.h"

#include <bit>
#include <cstring>
#include <ios>
#include <sstream>

#include <fmt/format.h>

#include "core/error.h"

namespace patrol::app {
namespace {

static_assert(std::endian::native == std::endian::little, "words are hashed in the byte order of the memory");

constexpr std::uint64_t kMurmurFactor = 0xc6a4a7935bd1e995ULL;

std::uint64_t mix(std::uint64_t value) { return value ^ (value >> 47U); }

/// MurmurHash64A of A. Appleby: the same in every program, unlike std::hash, and fast for states of megabytes.
std::uint64_t murmur_hash(std::string_view bytes) {
  constexpr std::uint64_t kSeed = 0xc70f6907ULL;
  std::uint64_t hash = kSeed ^ (bytes.size() * kMurmurFactor), word = 0;
  for (; bytes.size() >= sizeof(word); bytes.remove_prefix(sizeof(word))) {
    std::memcpy(&word, bytes.data(), sizeof(word));
    hash = (hash ^ (mix(word * kMurmurFactor) * kMurmurFactor)) * kMurmurFactor;
  }
  if (!bytes.empty()) {
    word = 0;
    std::memcpy(&word, bytes.data(), bytes.size());
    hash = (hash ^ word) * kMurmurFactor;
  }
  return mix(mix(hash) * kMurmurFactor);
}

}  // namespace

std::uint64_t hash_bytes(std::string_view bytes, std::uint64_t before) {
  constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15ULL;
  return before ^ (murmur_hash(bytes) + kGolden + (before << 6U) + (before >> 2U));
}

std::string to_text(const TickDigest& tick) {
  return fmt::format("{} {:016x} {:016x} {:016x} {:016x}", tick.time.count(), tick.motion, tick.messages,
                     tick.simulator, tick.stack);
}

TickDigest parse_tick_digest(const std::string& line) {
  std::istringstream words(line);
  TickDigest tick;
  std::int64_t time_ns = 0;
  words >> time_ns >> std::hex >> tick.motion >> tick.messages >> tick.simulator >> tick.stack;
  if (!words) throw InputError("not a line of a trace: " + line);
  tick.time = Time{time_ns};
  return tick;
}

}  // namespace patrol::app
