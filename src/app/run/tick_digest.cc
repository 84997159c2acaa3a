#include "app/run/tick_digest.h"

#include <functional>
#include <ios>
#include <sstream>

#include <fmt/format.h>

#include "core/error.h"

namespace patrol::app {

std::uint64_t hash_bytes(std::string_view bytes, std::uint64_t before) {
  constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15ULL;
  return before ^ (std::hash<std::string_view>{}(bytes) + kGolden + (before << 6U) + (before >> 2U));
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
