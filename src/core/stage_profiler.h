#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>

namespace patrol {

/// Profiler of wall-clock time and calls by stage ("physics", "lidar", "slam", ...). The results go to `performance` in
/// metrics.json only: no decision may depend on them.
class StageProfiler {
 public:
  /// Scoped timer: adds its lifetime to the total of its stage.
  class ScopedTimer {
   public:
    explicit ScopedTimer(double& total_s) : total_s_(total_s), start_(std::chrono::steady_clock::now()) {}
    ~ScopedTimer() { total_s_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
    ScopedTimer(const ScopedTimer&) = delete;
    ScopedTimer& operator=(const ScopedTimer&) = delete;

   private:
    double& total_s_;
    std::chrono::steady_clock::time_point start_;
  };

  [[nodiscard]] ScopedTimer time_stage(const std::string& part) {
    ++calls_[part];
    return ScopedTimer(seconds_[part]);
  }
  /// Adds the times and calls of another profiler.
  void add(const StageProfiler& other) {
    for (const auto& [part, seconds] : other.seconds_) seconds_[part] += seconds;
    for (const auto& [part, calls] : other.calls_) calls_[part] += calls;
  }
  const std::map<std::string, double>& seconds() const { return seconds_; }
  const std::map<std::string, std::uint64_t>& calls() const { return calls_; }

 private:
  std::map<std::string, double> seconds_;
  std::map<std::string, std::uint64_t> calls_;
};

}  // namespace patrol
