#pragma once

#include <chrono>
#include <map>
#include <string>

namespace patrol {

/// Where the wall-clock time goes, by part ("physics", "lidar", "slam", ...). Feeds `performance` in metrics.json and
/// nothing else: no decision may depend on it.
class PartClock {
 public:
  /// Adds the time until it goes out of scope to its part.
  class Lap {
   public:
    explicit Lap(double& total_s) : total_s_(total_s), start_(std::chrono::steady_clock::now()) {}
    ~Lap() {
      total_s_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }
    Lap(const Lap&) = delete;
    Lap& operator=(const Lap&) = delete;

   private:
    double& total_s_;
    std::chrono::steady_clock::time_point start_;
  };

  [[nodiscard]] Lap lap(const std::string& part) { return Lap(seconds_[part]); }
  const std::map<std::string, double>& seconds() const { return seconds_; }

 private:
  std::map<std::string, double> seconds_;
};

}  // namespace patrol
