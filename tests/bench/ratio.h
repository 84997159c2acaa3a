#pragma once

#include <benchmark/benchmark.h>

#include "core/thread_cpu_time.h"

namespace patrol::bench {

/// Times a subject against a reference, in turns within one process, so that both see the same machine in the
/// same mood.
class Ratio {
 public:
  template <typename Work>
  void reference(Work work) {
    reference_s_ += seconds_of(work);
  }
  /// Its time, s: for SetIterationTime.
  template <typename Work>
  double subject(Work work) {
    const double seconds = seconds_of(work);
    subject_s_ += seconds;
    return seconds;
  }

  /// Subject over reference: under 1 is faster.
  void report(benchmark::State& state) const {
    state.counters["ratio"] = subject_s_ / reference_s_;
    state.counters["speed_up"] = reference_s_ / subject_s_;
  }

 private:
  template <typename Work>
  static double seconds_of(Work& work) {
    const double start = thread_cpu_time_s();
    work();
    return thread_cpu_time_s() - start;
  }

  double reference_s_ = 0.0, subject_s_ = 0.0;
};

}  // namespace patrol::bench
