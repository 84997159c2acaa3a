#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "core/time.h"

namespace patrol::app {

/// Hashes of a run at the start of a tick, to compare two runs of one machine.
struct TickDigest {
  Time time{};
  std::uint64_t motion = 0;     ///< joint positions and velocities of the simulated world
  std::uint64_t messages = 0;   ///< messages of simulator and stack since the start of the trace
  std::uint64_t simulator = 0;  ///< whole state of the simulator
  std::uint64_t stack = 0;      ///< whole state of the stack
};

/// Hash of bytes, continued from another hash. Every program computes the same one.
std::uint64_t hash_bytes(std::string_view bytes, std::uint64_t before = 0);

/// One line: the time in nanoseconds and the hashes in hexadecimal digits.
std::string to_text(const TickDigest& tick);
/// Throws InputError if the line is not that of a tick.
TickDigest parse_tick_digest(const std::string& line);

}  // namespace patrol::app
