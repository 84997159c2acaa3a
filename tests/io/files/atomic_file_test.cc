#include "io/files/atomic_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "io/files/bounded_read.h"
#include "io/files/output_error.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::atomic_file_test {
namespace {

using test::read_bytes, test::TemporaryFolder;

std::size_t num_files(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

TEST(SaveText, ReplacesTheFileAndLeavesNothingBeside) {
  const TemporaryFolder folder;
  save_text(folder / "a.txt", "old and longer");
  save_text(folder / "a.txt", std::string("new\0line", 8));
  EXPECT_EQ(read_bytes(folder / "a.txt"), std::string("new\0line", 8));
  EXPECT_EQ(num_files(folder.path()), 1U);
}

/// Path of the new file while it is written.
std::filesystem::path part_of(const std::filesystem::path& file) {
  return file.string() + "." + std::to_string(::getpid()) + ".part";
}

TEST(SaveText, WhenWritingFailsTheOldFileStandsUntouched) {
  const TemporaryFolder folder;
  save_text(folder / "a.txt", "old");
  std::filesystem::create_directory(part_of(folder / "a.txt"));
  EXPECT_THROW(save_text(folder / "a.txt", "new"), InputError);
  EXPECT_EQ(read_bytes(folder / "a.txt"), "old");
}

TEST(SaveText, WhenTheNameIsTakenByAFolderNothingIsLeft) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "a.txt" / "full");
  try {
    save_text(folder / "a.txt", "new");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()), (folder / "a.txt").string() + ": cannot be written");
  }
  EXPECT_EQ(num_files(folder.path()), 1U);
}

TEST(SaveText, AFullDiskIsSaid) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  const TemporaryFolder folder;
  std::filesystem::create_symlink("/dev/full", part_of(folder / "a.txt"));
  EXPECT_THAT([&] { save_text(folder / "a.txt", "new"); }, testing::ThrowsMessage<OutputError>(testing::EndsWith(
                                                               "a.txt: cannot be written: No space left on device")));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.txt"));
}

TEST(LoadText, GivesEveryByteAndRefusesWhatIsNoFile) {
  const TemporaryFolder folder;
  const std::string bytes("\x00\r\n\xff", 4);
  save_text(folder / "a.txt", bytes);
  EXPECT_EQ(load_text(folder / "a.txt"), bytes);
  save_text(folder / "empty.txt", "");
  EXPECT_EQ(load_text(folder / "empty.txt"), "");
  EXPECT_THROW(load_text(folder / "missing.txt"), InputError);
  EXPECT_THROW(load_text(folder.path()), InputError);
}

TEST(LoadText, RefusesDevicesPipesAndFilesOverTheLimit) {
  const TemporaryFolder folder;
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_THROW(load_text(folder / "pipe"), InputError);
  EXPECT_THROW(load_text("/dev/zero"), InputError);
  std::filesystem::create_symlink("loop", folder / "loop");
  EXPECT_THROW(load_text(folder / "loop"), InputError);
  save_text(folder / "a.txt", "12345");
  EXPECT_EQ(load_text(folder / "a.txt", 5), "12345");
  EXPECT_THROW(load_text(folder / "a.txt", 4), InputError);
  std::filesystem::resize_file(folder / "a.txt", kMaxFileBytes + 1);  // sparse
  EXPECT_THROW(load_text(folder / "a.txt"), InputError);
}

}  // namespace
}  // namespace patrol::io::atomic_file_test
