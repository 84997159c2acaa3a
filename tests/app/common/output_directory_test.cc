#include "app/common/output_directory.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/temporary_file.h"

namespace patrol::app::output_directory_test {
namespace {

using test::TemporaryFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const OutputKind kKind = {.name = "survey",
                          .marker_text = "Not yet.",
                          .outputs = {"table.csv", "plot_*.png", "work/deep/*.txt", "work/*.part"},
                          .required_file = "table.csv",
                          .preserved = {"results"}};

std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

TEST(OutputDirectory, IsMadeWithItsParentsAndMarkedUntilItIsComplete) {
  const TemporaryFolder folder;
  const OutputLock lock = begin_output(folder / "a/b", kKind);
  EXPECT_EQ(test::read_bytes(incomplete_marker(folder / "a/b")), "Not yet.\n");
  complete_output(folder / "a/b");
  EXPECT_THAT(names_in(folder / "a/b"), ElementsAre());
}

TEST(OutputDirectory, WhatIsMadeAnewGoesAndWhatIsKeptStays) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "work/deep");
  for (const char* name : {"table.csv", "plot_1.png", "results", "work/deep/1.txt"})
    test::write_bytes(folder / name, "old");
  const OutputLock lock = begin_output(folder.path(), kKind);
  EXPECT_THAT(names_in(folder.path()), ElementsAre("INCOMPLETE", "results"));
}

TEST(OutputDirectory, OneThatHoldsAnythingElseIsRefusedAndLeftAsItWas) {
  const TemporaryFolder folder;
  for (const char* name : {"table.csv", "thesis.tex"}) test::write_bytes(folder / name, "mine");
  EXPECT_THAT([&] { (void)begin_output(folder.path(), kKind); },
              ThrowsMessage<InputError>(HasSubstr("contains 'thesis.tex', which is not an output of 'survey'")));
  EXPECT_THAT(names_in(folder.path()), ElementsAre("table.csv", "thesis.tex"));
}

/// The complaint about `folder`; empty when it is accepted.
std::string complaint_about(const std::filesystem::path& folder) {
  try {
    (void)begin_output(folder, kKind);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(OutputDirectory, AUsersFilesInOurFoldersAndFoldersOfOurNamesStay) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "work/deep");
  for (const char* name : {"table.csv", "work/deep/1.txt"}) test::write_bytes(folder / name, "ours");
  test::write_bytes(folder / "work/deep/thesis.tex", "mine");
  EXPECT_THAT(complaint_about(folder.path()),
              HasSubstr("contains 'work/deep/thesis.tex', which is not an output of 'survey'"));
  EXPECT_EQ(test::read_bytes(folder / "work/deep/thesis.tex"), "mine");
  EXPECT_EQ(test::read_bytes(folder / "work/deep/1.txt"), "ours");
  std::filesystem::remove(folder / "work/deep/thesis.tex");

  std::filesystem::create_directories(folder / "plot_1.png");
  test::write_bytes(folder / "plot_1.png/mine", "mine");
  EXPECT_THAT(complaint_about(folder.path()), HasSubstr("contains 'plot_1.png'"));
  std::filesystem::remove_all(folder / "plot_1.png");

  test::write_bytes(folder / "thesis.tex", "mine");
  const TemporaryFolder linking;
  for (const char* name : {"plot_1.png", "work"}) {
    std::filesystem::create_symlink(folder / "thesis.tex", linking / name);
    EXPECT_THAT(complaint_about(linking.path()), HasSubstr(std::string("contains '") + name));
    std::filesystem::remove(linking / name);
  }
  EXPECT_THAT(names_in(linking.path()), ElementsAre());
  EXPECT_EQ(test::read_bytes(folder / "thesis.tex"), "mine");
}

TEST(OutputDirectory, FilesOfOurNamesWithoutSignOfAnEarlierOneStay) {
  const TemporaryFolder folder;
  test::write_bytes(folder / "plot_1.png", "mine");
  EXPECT_THAT(complaint_about(folder.path()), HasSubstr("contains plot_1.png, but no table.csv of an earlier survey"));
  EXPECT_THAT(names_in(folder.path()), ElementsAre("plot_1.png"));
  test::write_bytes(incomplete_marker(folder.path()), "Not yet.\n");
  EXPECT_EQ(complaint_about(folder.path()), "");
  EXPECT_THAT(names_in(folder.path()), ElementsAre("INCOMPLETE"));
}

TEST(OutputDirectory, NothingIsWrittenThroughALinkedMark) {
  const TemporaryFolder folder, elsewhere;
  test::write_bytes(elsewhere / "precious", "mine");
  std::filesystem::create_symlink(elsewhere / "precious", incomplete_marker(folder.path()));
  EXPECT_THAT(complaint_about(folder.path()), HasSubstr("INCOMPLETE: must be a regular file"));
  std::filesystem::remove(incomplete_marker(folder.path()));
  std::filesystem::create_hard_link(elsewhere / "precious", incomplete_marker(folder.path()));
  EXPECT_THAT(complaint_about(folder.path()), HasSubstr("INCOMPLETE: must be a regular file"));
  std::filesystem::remove(incomplete_marker(folder.path()));
  std::filesystem::create_directory(incomplete_marker(folder.path()));
  EXPECT_THAT(complaint_about(folder.path()), HasSubstr("INCOMPLETE: must be a regular file"));
  EXPECT_EQ(test::read_bytes(elsewhere / "precious"), "mine");
}

/// A process that begins to write to `folder`, and goes on until it is killed.
class Writer {
 public:
  explicit Writer(const std::filesystem::path& folder, const OutputKind& kind = kKind) : pid_(::fork()) {
    if (pid_ == 0) {
      const OutputLock lock = begin_output(folder, kind);
      test::write_bytes(folder / "table.csv", "written");
      while (true) ::pause();
    }
    while (!std::filesystem::exists(folder / "table.csv")) ::usleep(1000);
  }
  ~Writer() { kill(); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  void kill() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
    pid_ = -1;
  }

 private:
  pid_t pid_;
};

TEST(OutputDirectory, OneProcessAtATimeWritesThereAndAKilledOneDoesNotBlock) {
  const TemporaryFolder folder;
  Writer first(folder / "out");
  EXPECT_THAT(complaint_about(folder / "out"), HasSubstr("in use by another process that writes a survey"));
  EXPECT_EQ(test::read_bytes(folder / "out/table.csv"), "written");
  first.kill();
  EXPECT_EQ(complaint_about(folder / "out"), "");
  EXPECT_THAT(names_in(folder / "out"), ElementsAre("INCOMPLETE"));
}

TEST(OutputDirectory, OneThatIsSharedTakesSeveral) {
  OutputKind shared = kKind;
  shared.is_concurrent = true;
  const TemporaryFolder folder;
  const Writer first(folder / "out", shared);
  const OutputLock lock = begin_output(folder / "out", shared);
}

TEST(OutputDirectory, AFileInItsPlaceIsRefused) {
  const TemporaryFolder folder;
  test::write_bytes(folder / "out", "a file");
  EXPECT_THROW((void)begin_output(folder / "out", kKind), InputError);
}

}  // namespace
}  // namespace patrol::app::output_directory_test
