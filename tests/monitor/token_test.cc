#include "monitor/token.h"

#include <sys/stat.h>

#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/temporary_file.h"

namespace patrol::monitor::token_test {
namespace {

TEST(Token, IsMadeOnceForItsOwnersEyesAlone) {
  const test::TemporaryFolder folder;
  const std::string token = load_or_create_token(folder.path());
  EXPECT_EQ(token.size(), 64U);
  EXPECT_EQ(load_or_create_token(folder.path()), token);
  struct stat info {};
  ASSERT_EQ(::stat((folder / "token").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777U, 0600U);
}

TEST(Token, IsItsOwnersAloneAlthoughAnotherFileWasLeftInItsPlace) {
  const test::TemporaryFolder folder;
  test::write_bytes(folder / "token.part", "");
  ASSERT_EQ(::chmod((folder / "token.part").c_str(), 0644), 0);
  load_or_create_token(folder.path());
  struct stat info {};
  ASSERT_EQ(::stat((folder / "token").c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777U, 0600U);
}

TEST(Token, OfAFileIsItsFirstLine) {
  EXPECT_EQ(load_token(test::TemporaryFile("token", "0123456789abcdef\r\nmore\n").path()), "0123456789abcdef");
}

TEST(Token, TooShortOrNotPlainIsRefused) {
  EXPECT_THROW(load_token(test::TemporaryFile("token", "short\n").path()), InputError);
  EXPECT_THROW(check_token("x", "0123456789 abcdef"), InputError);
  EXPECT_THROW(check_token("x", "0123456789abcde\xc3\xa9"), InputError);
}

TEST(Token, OnlyTheWholeIsTheSame) {
  EXPECT_TRUE(is_same_token("0123456789abcdef", "0123456789abcdef"));
  for (const char* other : {"", "0", "0123456789abcdeg", "0123456789abcdef0", "0123456789abcde"})
    EXPECT_FALSE(is_same_token(other, "0123456789abcdef")) << other;
  EXPECT_FALSE(is_same_token("", ""));
}

}  // namespace
}  // namespace patrol::monitor::token_test
