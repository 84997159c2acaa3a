#include "app/output_directory.h"

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

const OutputKind kKind = {.name = "survey", .unfinished = "Not yet.", .made = {"table.csv", "plot_*.png", "work"}, .kept = {"results"}};

std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

TEST(OutputDirectory, IsMadeWithItsParentsAndMarkedUntilItIsComplete) {
  const TemporaryFolder folder;
  begin_output(folder / "a/b", kKind);
  EXPECT_EQ(test::read_bytes(incomplete_marker(folder / "a/b")), "Not yet.\n");
  complete_output(folder / "a/b");
  EXPECT_THAT(names_in(folder / "a/b"), ElementsAre());
}

TEST(OutputDirectory, WhatIsMadeAnewGoesAndWhatIsKeptStays) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "work/deep");
  for (const char* name : {"table.csv", "plot_1.png", "results"}) test::write_bytes(folder / name, "old");
  begin_output(folder.path(), kKind);
  EXPECT_THAT(names_in(folder.path()), ElementsAre("INCOMPLETE", "results"));
}

TEST(OutputDirectory, OneThatHoldsAnythingElseIsRefusedAndLeftAsItWas) {
  const TemporaryFolder folder;
  for (const char* name : {"table.csv", "thesis.tex"}) test::write_bytes(folder / name, "mine");
  EXPECT_THAT([&] { begin_output(folder.path(), kKind); },
              ThrowsMessage<InputError>(HasSubstr("holds thesis.tex, which is not part of a survey")));
  EXPECT_THAT(names_in(folder.path()), ElementsAre("table.csv", "thesis.tex"));
}

TEST(OutputDirectory, AFileInItsPlaceIsRefused) {
  const TemporaryFolder folder;
  test::write_bytes(folder / "out", "a file");
  EXPECT_THROW(begin_output(folder / "out", kKind), InputError);
}

}  // namespace
}  // namespace patrol::app::output_directory_test
