#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace patrol {

/// Random numbers addressed, not drawn: the value at (seed, stream name, tick, index) is always the same, whatever else
/// was asked before and by whom. Switching one imperfection off therefore changes no other draw, and threads change
/// nothing. Philox 4x64-10 (Salmon et al., SC'11), by Random123; our own distributions, since those of <random> differ
/// between standard libraries.
class RandomStream {
 public:
  /// `name` is a path such as "lidar/front/range" or "pedestrian/3".
  RandomStream(std::uint64_t seed, std::string_view name);

  /// Uniform in the open interval (0, 1).
  double uniform(std::uint64_t tick, std::uint64_t index = 0) const;

  /// Standard normal (Box-Muller).
  double normal(std::uint64_t tick, std::uint64_t index = 0) const;

  /// Four standard normals of one address, for about the price of two. The first is normal(tick, index).
  std::array<double, 4> normals(std::uint64_t tick, std::uint64_t index = 0) const;

 private:
  std::uint64_t seed_;
  std::uint64_t stream_;
};

}  // namespace patrol
