#pragma once

#include <malloc.h>
#include <sys/resource.h>

#include <chrono>
#include <ctime>

/// Time and memory of the process, for `performance` in metrics.json and for display. No decision may depend on them.
namespace patrol::app {

/// Time of a steady clock; only differences have a meaning.
inline double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// CPU time of all threads of this process.
inline double process_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Maximum resident memory of this process, in units of 10^6 bytes.
inline double peak_memory_mb() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return 1.024e-3 * static_cast<double>(usage.ru_maxrss);  // NOLINT(cppcoreguidelines-pro-type-union-access): by glibc
}

/// Current heap memory, in units of 10^6 bytes.
inline double heap_mb() {
  const struct mallinfo2 info = ::mallinfo2();
  return 1e-6 * static_cast<double>(info.uordblks + info.hblkhd);
}

}  // namespace patrol::app
