#pragma once

#include <array>
#include <cstddef>
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

  /// Four of one address, for the price of one. The first is uniform(tick, index).
  std::array<double, 4> uniforms(std::uint64_t tick, std::uint64_t index = 0) const;

  /// Four standard normals of one address, for about the price of two. The first is normal(tick, index).
  std::array<double, 4> normals(std::uint64_t tick, std::uint64_t index = 0) const;

 private:
  std::uint64_t seed_;
  std::uint64_t stream_;
};

/// Draws one after the other, where how many are needed depends on what they were: all of one tick of a stream.
class RandomSequence {
 public:
  RandomSequence(const RandomStream& stream, std::uint64_t tick) : stream_(stream), tick_(tick) {}

  /// Uniform in the open interval (0, 1).
  double uniform();
  /// Standard normal.
  double normal();
  /// Standard Cauchy.
  double cauchy();
  /// 0 ... count - 1, each alike.
  std::size_t index(std::size_t count);

 private:
  RandomStream stream_;
  std::uint64_t tick_;
  std::uint64_t next_uniform_ = 0, next_normal_ = 0;
  std::array<double, 4> uniforms_{}, normals_{};
};

}  // namespace patrol
