#include "app/run/tick_digest.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace patrol::app::tick_digest_test {
namespace {

// `patrol bisect --program-b` compares the hashes of two programs, which may be built with different standard
// libraries.
TEST(TickDigest, HashesAreTheSameInEveryProgram) {
  const std::uint64_t topic = hash_bytes("/odometry");
  EXPECT_EQ(topic, 0x59cb1aaba8589790ULL);
  EXPECT_EQ(hash_bytes(std::string_view("\0\1", 2), topic), 0xbe0e8e2807a5ff79ULL);
}

TEST(TickDigest, ALineIsReadAsItWasWritten) {
  const TickDigest tick{
      .time = Time{2'000'000}, .motion = 1, .messages = 0xffffffffffffffffULL, .simulator = 3, .stack = 4};
  EXPECT_EQ(to_text(parse_tick_digest(to_text(tick))), to_text(tick));
  EXPECT_THROW(parse_tick_digest("2000000 1 2"), InputError);
}

}  // namespace
}  // namespace patrol::app::tick_digest_test
