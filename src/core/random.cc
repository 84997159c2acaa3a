#include "core/random.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Random123/philox.h>

namespace patrol {
namespace {

/// FNV-1a hash, 64 bits: stable across builds and platforms, unlike std::hash.
std::uint64_t hash_of(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3ULL;
  }
  return hash;
}

std::array<std::uint64_t, 4> bits_at(std::uint64_t seed, std::uint64_t stream, std::uint64_t tick,
                                     std::uint64_t index) {
  const r123::Philox4x64 philox;
  const r123::Philox4x64::ctr_type out = philox({{tick, index, 0, 0}}, {{seed, stream}});
  return {out[0], out[1], out[2], out[3]};
}

/// Converts 53 random bits to the center of their interval: never 0, never 1.
double to_unit(std::uint64_t bits) { return (static_cast<double>(bits >> 11) + 0.5) * 0x1.0p-53; }

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::string_view name) : seed_(seed), stream_(hash_of(name)) {}

double RandomStream::uniform(std::uint64_t tick, std::uint64_t index) const {
  return to_unit(bits_at(seed_, stream_, tick, index)[0]);
}

double RandomStream::normal(std::uint64_t tick, std::uint64_t index) const {
  const auto bits = bits_at(seed_, stream_, tick, index);
  return std::sqrt(-2.0 * std::log(to_unit(bits[0]))) * std::cos(2.0 * std::numbers::pi * to_unit(bits[1]));
}

std::array<double, 4> RandomStream::uniforms(std::uint64_t tick, std::uint64_t index) const {
  const auto bits = bits_at(seed_, stream_, tick, index);
  return {to_unit(bits[0]), to_unit(bits[1]), to_unit(bits[2]), to_unit(bits[3])};
}

std::array<double, 4> RandomStream::normals(std::uint64_t tick, std::uint64_t index) const {
  const auto bits = bits_at(seed_, stream_, tick, index);
  std::array<double, 4> drawn{};
  for (std::size_t pair = 0; pair < 4; pair += 2) {
    const double radius = std::sqrt(-2.0 * std::log(to_unit(bits[pair])));
    const double angle = 2.0 * std::numbers::pi * to_unit(bits[pair + 1]);
    drawn[pair] = radius * std::cos(angle), drawn[pair + 1] = radius * std::sin(angle);
  }
  return drawn;
}

// Uniform numbers use even indices, normal numbers odd ones, so that the two do not affect each other.
double RandomSequence::uniform() {
  const std::uint64_t n = next_uniform_++;
  if (n % 4 == 0) uniforms_ = stream_.uniforms(tick_, n / 2);
  return uniforms_[n % 4];
}

double RandomSequence::normal() {
  const std::uint64_t n = next_normal_++;
  if (n % 4 == 0) normals_ = stream_.normals(tick_, n / 2 + 1);
  return normals_[n % 4];
}

double RandomSequence::cauchy() { return std::tan(std::numbers::pi * (uniform() - 0.5)); }

std::size_t RandomSequence::index(std::size_t count) {
  return std::min(static_cast<std::size_t>(uniform() * static_cast<double>(count)), count - 1);
}

}  // namespace patrol
