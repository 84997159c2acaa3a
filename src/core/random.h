#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace patrol {

/// Counter-based random numbers: the value at (seed, stream name, tick, index) does not depend on other calls, their
/// order or their thread. Disabling one error source therefore leaves the random numbers of all others unchanged.
/// Philox 4x64-10 [Salmon11] from Random123. The distributions are implemented here because those of <random> differ
/// between standard libraries.
class RandomStream {
 public:
  /// Creates a stream. `name` is a path such as "lidar/front/range" or "pedestrian/3".
  RandomStream(std::uint64_t seed, std::string_view name);

  /// Returns a uniform number in the open interval (0, 1).
  double uniform(std::uint64_t tick, std::uint64_t index = 0) const;

  /// Returns a standard normal number (Box-Muller transform).
  double normal(std::uint64_t tick, std::uint64_t index = 0) const;

  /// Returns four uniform numbers of one counter at the cost of one. The first equals uniform(tick, index).
  std::array<double, 4> uniforms(std::uint64_t tick, std::uint64_t index = 0) const;

  /// Returns four standard normal numbers of one counter at about the cost of two. The first equals normal(tick,
  /// index).
  std::array<double, 4> normals(std::uint64_t tick, std::uint64_t index = 0) const;

 private:
  std::uint64_t seed_;
  std::uint64_t stream_;
};

/// Sequence of random numbers within one tick of a stream, for algorithms that need a data-dependent number of them.
class RandomSequence {
 public:
  RandomSequence(const RandomStream& stream, std::uint64_t tick) : stream_(stream), tick_(tick) {}

  /// Returns a uniform number in the open interval (0, 1).
  double uniform();
  /// Returns a standard normal number.
  double normal();
  /// Returns a standard Cauchy number.
  double cauchy();
  /// Returns a uniform integer in [0, count - 1].
  std::size_t index(std::size_t count);

 private:
  RandomStream stream_;
  std::uint64_t tick_;
  std::uint64_t next_uniform_ = 0, next_normal_ = 0;
  std::array<double, 4> uniforms_{}, normals_{};
};

}  // namespace patrol
