#include "app/cli/renamed_options.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"

namespace patrol::app::renamed_options_test {
namespace {

/// Message of the error for a command line; empty if it is accepted.
std::string complaint_about(std::vector<const char*> words) {
  words.insert(words.begin(), "patrol");
  try {
    refuse_renamed(static_cast<int>(words.size()), words.data());
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(RenamedOptions, FormerCommandNamesThePresentOne) {
  EXPECT_EQ(complaint_about({"collect", "out/sweep"}), "collect: renamed to merge");
  EXPECT_EQ(complaint_about({"send", "out/run"}), "send: renamed to upload");
  EXPECT_EQ(complaint_about({"train-neighbours"}), "train-neighbours: renamed to train-neighbors");
}

TEST(RenamedOptions, FormerOptionNamesThePresentOneWithAndWithoutItsValue) {
  EXPECT_EQ(complaint_about({"localizability", "a.yaml", "--step-m", "1"}), "--step-m: renamed to --grid-step-m");
  EXPECT_EQ(complaint_about({"localizability", "a.yaml", "--step-m=1"}), "--step-m: renamed to --grid-step-m");
  EXPECT_EQ(complaint_about({"replay", "out/run", "--cut", "plain"}),
            "--cut: renamed to --style (story: highlights, plain: continuous)");
  EXPECT_EQ(complaint_about({"budget", "a.yaml", "--run-limit-s", "9"}), "--run-limit-s: renamed to --run-timeout-s");
}

TEST(RenamedOptions, NameThatAnotherCommandStillHasIsAccepted) {
  EXPECT_EQ(complaint_about({"upload", "out/run", "--to", "http://localhost:1"}), "--to: renamed to --monitor-url");
  EXPECT_EQ(complaint_about({"plan", "map.yaml", "--from", "0,0", "--to", "1,1"}), "");
}

TEST(RenamedOptions, PresentNamesAndOtherWordsAreAccepted) {
  EXPECT_EQ(complaint_about({}), "");
  EXPECT_EQ(complaint_about({"--help"}), "");
  EXPECT_EQ(complaint_about({"sweep", "send", "--early-stop", "--keep-runs", "all", "--set", "a=--margin"}), "");
  EXPECT_EQ(complaint_about({"sweep", "--", "--margin"}), "");
}

}  // namespace
}  // namespace patrol::app::renamed_options_test
