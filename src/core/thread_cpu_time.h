#pragma once

#include <ctime>

namespace patrol {

/// Returns the CPU time of the calling thread, s. Unaffected by the load of the machine.
inline double thread_cpu_time_s() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace patrol
