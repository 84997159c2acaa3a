#include "core/random.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

namespace patrol::random_test {
namespace {

using Block = std::array<std::uint64_t, 4>;

// Philox 4x64-10 as the paper's figure 2 has it: slow and obvious, to hold the library's use against.
Block philox(Block c, std::array<std::uint64_t, 2> key) {
  __extension__ using Wide = unsigned __int128;
  for (int round = 0; round < 10; ++round) {
    const Wide left = Wide{0xD2E7470EE14C6C93ULL} * c[0], right = Wide{0xCA5A826395121157ULL} * c[2];
    c = {static_cast<std::uint64_t>(right >> 64) ^ c[1] ^ key[0], static_cast<std::uint64_t>(right),
         static_cast<std::uint64_t>(left >> 64) ^ c[3] ^ key[1], static_cast<std::uint64_t>(left)};
    key[0] += 0x9E3779B97F4A7C15ULL;
    key[1] += 0xBB67AE8584CAA73BULL;
  }
  return c;
}

double unit(std::uint64_t bits) { return (static_cast<double>(bits >> 11) + 0.5) / 9007199254740992.0; }

// Known answers from Random123's own file of test vectors.
TEST(Philox, GivesThePublishedAnswersForZerosAndForPi) {
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}),
            (Block{0x16554d9eca36314cULL, 0xdb20fe9d672d0fdcULL, 0xd7e772cee186176bULL, 0x7e68b68aec7ba23bULL}));
  EXPECT_EQ(philox({0x243f6a8885a308d3ULL, 0x13198a2e03707344ULL, 0xa4093822299f31d0ULL, 0x082efa98ec4e6c89ULL},
                   {0x452821e638d01377ULL, 0xbe5466cf34e90c6cULL}),
            (Block{0xa528f45403e61d95ULL, 0x38c72dbd566e9788ULL, 0xa5a1610e72fd18b5ULL, 0x57bd43b5e52b7fe6ULL}));
}

// "foobar" has the FNV-1a hash 85944171f73967e8 (Noll's test vectors).
TEST(RandomStream, IsPhiloxOfTickAndIndexKeyedBySeedAndNameHash) {
  const RandomStream stream(42, "foobar");
  for (const std::uint64_t tick : {0ULL, 1ULL, 987654321ULL, ~0ULL}) {
    for (const std::uint64_t index : {0ULL, 7ULL}) {
      const Block bits = philox({tick, index, 0, 0}, {42, 0x85944171f73967e8ULL});
      EXPECT_DOUBLE_EQ(stream.uniform(tick, index), unit(bits[0]));
      EXPECT_DOUBLE_EQ(stream.normal(tick, index),
                       std::sqrt(-2.0 * std::log(unit(bits[0]))) * std::cos(2.0 * std::numbers::pi * unit(bits[1])));
    }
  }
}

TEST(RandomStream, SameAddressSameValueWhateverWasAskedBetween) {
  const RandomStream stream(1, "lidar/front/range");
  const double first = stream.normal(5, 3);
  for (std::uint64_t i = 0; i < 100; ++i) stream.uniform(i);
  EXPECT_EQ(stream.normal(5, 3), first);
  EXPECT_EQ(RandomStream(1, "lidar/front/range").normal(5, 3), first);
}

TEST(RandomStream, SeedNameTickAndIndexEachMakeANewNumber) {
  std::set<double> values;
  for (const std::uint64_t seed : {1ULL, 2ULL}) {
    for (const char* name : {"pedestrian/1", "pedestrian/2", ""}) {
      for (const std::uint64_t tick : {0ULL, 1ULL}) {
        for (const std::uint64_t index : {0ULL, 1ULL}) values.insert(RandomStream(seed, name).uniform(tick, index));
      }
    }
  }
  EXPECT_EQ(values.size(), 2U * 3U * 2U * 2U);
}

constexpr int kDraws = 200'000;

struct Moments {
  double mean = 0.0, variance = 0.0, fourth = 0.0;
};

template <typename Draw>
Moments moments_of(const Draw& draw) {
  Moments m;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const double x = draw(i);
    m.mean += x / kDraws;
    m.variance += x * x / kDraws;
    m.fourth += x * x * x * x / kDraws;
  }
  m.variance -= m.mean * m.mean;
  return m;
}

// Bounds: four standard errors of the sample's moments.
TEST(RandomStream, UniformHasMeanHalfAndVarianceOneTwelfth) {
  const RandomStream stream(3, "test/uniform");
  const Moments m = moments_of([&](std::uint64_t i) {
    const double u = stream.uniform(i);
    EXPECT_GT(u, 0.0);
    EXPECT_LT(u, 1.0);
    return u;
  });
  EXPECT_NEAR(m.mean, 0.5, 4.0 * std::sqrt(1.0 / 12.0 / kDraws));
  EXPECT_NEAR(m.variance, 1.0 / 12.0, 4.0 * std::sqrt((1.0 / 80.0 - 1.0 / 144.0) / kDraws));
}

TEST(RandomStream, NormalHasTheMomentsZeroOneThree) {
  const RandomStream stream(3, "test/normal");
  const Moments m = moments_of([&](std::uint64_t i) { return stream.normal(i); });
  EXPECT_NEAR(m.mean, 0.0, 4.0 / std::sqrt(kDraws));
  EXPECT_NEAR(m.variance, 1.0, 4.0 * std::sqrt(2.0 / kDraws));
  EXPECT_NEAR(m.fourth, 3.0, 4.0 * std::sqrt(96.0 / kDraws));  // var of x^4 is 105 - 9
}

TEST(RandomStream, NeighbouringStreamsTicksAndIndexesAreUncorrelated) {
  const RandomStream a(3, "pedestrian/1"), b(3, "pedestrian/2");
  double streams = 0.0, ticks = 0.0, indexes = 0.0;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const double x = a.normal(i);
    streams += x * b.normal(i) / kDraws;
    ticks += x * a.normal(i + 1) / kDraws;
    indexes += x * a.normal(i, 1) / kDraws;
  }
  const double bound = 4.0 / std::sqrt(kDraws);
  EXPECT_NEAR(streams, 0.0, bound);
  EXPECT_NEAR(ticks, 0.0, bound);
  EXPECT_NEAR(indexes, 0.0, bound);
}

TEST(RandomStream, FourUniformsAreTheFourWordsOfOneAddress) {
  const RandomStream stream(42, "foobar");
  const Block bits = philox({7, 5, 0, 0}, {42, 0x85944171f73967e8ULL});
  const std::array<double, 4> drawn = stream.uniforms(7, 5);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_DOUBLE_EQ(drawn[i], unit(bits[i])) << i;
  EXPECT_EQ(drawn[0], stream.uniform(7, 5));
}

RandomSequence sequence(std::uint64_t tick = 1) { return {RandomStream(3, "test/sequence"), tick}; }

TEST(RandomSequence, SixUniformsStandAtTheAddressesZeroAndTwoAndSixNormalsAtOneAndThree) {
  const RandomStream stream(3, "test/sequence");
  RandomSequence drawn = sequence();
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(drawn.uniform(), stream.uniforms(1, i < 4 ? 0 : 2)[i % 4]) << i;
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(drawn.normal(), stream.normals(1, i < 4 ? 1 : 3)[i % 4]) << i;
}

TEST(RandomSequence, UniformsAndNormalsDoNotMoveEachOther) {
  RandomSequence uniforms = sequence(), normals = sequence(), mixed = sequence();
  for (int i = 0; i < 50; ++i) {
    for (int k = 0; k < i % 3; ++k) EXPECT_EQ(mixed.uniform(), uniforms.uniform()) << i;
    for (int k = 0; k < i % 4; ++k) EXPECT_EQ(mixed.normal(), normals.normal()) << i;
  }
}

TEST(RandomSequence, SameTickSameDrawsAndAnotherTickOthers) {
  RandomSequence first = sequence(), again = sequence(), other = sequence(2);
  for (int i = 0; i < 20; ++i) {
    const double drawn = first.uniform();
    EXPECT_EQ(again.uniform(), drawn) << i;
    EXPECT_NE(other.uniform(), drawn) << i;
  }
}

TEST(RandomSequence, TwoHundredThousandDrawsHaveTheMomentsOfTheirDistributions) {
  RandomSequence drawn = sequence();
  const Moments uniform = moments_of([&](std::uint64_t) { return drawn.uniform(); });
  EXPECT_NEAR(uniform.mean, 0.5, 4.0 * std::sqrt(1.0 / 12.0 / kDraws));
  EXPECT_NEAR(uniform.variance, 1.0 / 12.0, 4.0 * std::sqrt((1.0 / 80.0 - 1.0 / 144.0) / kDraws));
  const Moments normal = moments_of([&](std::uint64_t) { return drawn.normal(); });
  EXPECT_NEAR(normal.mean, 0.0, 4.0 / std::sqrt(kDraws));
  EXPECT_NEAR(normal.variance, 1.0, 4.0 * std::sqrt(2.0 / kDraws));
  EXPECT_NEAR(normal.fourth, 3.0, 4.0 * std::sqrt(96.0 / kDraws));
}

TEST(RandomSequence, NeighbouringDrawsAreUncorrelated) {
  RandomSequence drawn = sequence();
  double before = drawn.normal(), sum = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double next = drawn.normal();
    sum += before * next / kDraws;
    before = next;
  }
  EXPECT_NEAR(sum, 0.0, 4.0 / std::sqrt(kDraws));
}

// 22.46: the 99.9 % quantile of chi^2 with 6 degrees of freedom.
TEST(RandomSequence, IndexTakesEachOfSevenValuesAlike) {
  RandomSequence drawn = sequence();
  std::array<int, 7> counts{};
  for (int i = 0; i < 70'000; ++i) ++counts.at(drawn.index(7));
  double chi_squared = 0.0;
  for (const int count : counts) chi_squared += (count - 10'000.0) * (count - 10'000.0) / 10'000.0;
  EXPECT_LT(chi_squared, 22.46);
  EXPECT_EQ(drawn.index(1), 0U);
}

TEST(RandomSequence, CauchyHasItsQuartilesAtMinusOneZeroAndOne) {
  RandomSequence drawn = sequence();
  std::array<double, 3> below{};
  for (int i = 0; i < kDraws; ++i) {
    const double x = drawn.cauchy();
    for (std::size_t k = 0; k < 3; ++k) below[k] += x < static_cast<double>(k) - 1.0 ? 1.0 / kDraws : 0.0;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const double p = 0.25 * static_cast<double>(k + 1);
    EXPECT_NEAR(below[k], p, 4.0 * std::sqrt(p * (1.0 - p) / kDraws)) << k;
  }
}

}  // namespace
}  // namespace patrol::random_test
