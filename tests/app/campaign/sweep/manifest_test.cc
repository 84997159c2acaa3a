#include "app/campaign/sweep/manifest.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/temporary_file.h"

namespace patrol::app::manifest_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

SweepManifest small_manifest() {
  return {.scenario = "short.yaml",
          .overrides = {"time_limit_s=9"},
          .paths = {"a"},
          .variants = {{.name = "a=1", .overrides = {"a=1"}}, {.name = "a=2", .overrides = {"a=2"}}},
          .seeds = {1},
          .metrics = {"pose.ate_rmse_m"},
          .stop = {.is_early = true, .equivalence_margin = 0.5},
          .runs = {{.variant = 0, .seed = 1, .overrides = {"a=1"}, .hash = "aa"},
                   {.variant = 1, .seed = 1, .overrides = {"a=2"}, .hash = "bb"}}};
}

std::string message_of(const std::string& text) {
  const test::TemporaryFile file("sweep.json", text);
  try {
    load_manifest(file.path());
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Manifest, ComesBackAsItWasSaved) {
  const test::TemporaryFolder folder;
  save_manifest(folder / "a.json", small_manifest());
  const SweepManifest read = load_manifest(folder / "a.json");
  save_manifest(folder / "b.json", read);
  EXPECT_EQ(test::read_bytes(folder / "a.json"), test::read_bytes(folder / "b.json"));
  EXPECT_EQ(read.runs[1].hash, "bb");
  EXPECT_TRUE(read.stop.is_early);
}

TEST(Manifest, ARunsOverridesAreTheCommonOnesItsOwnAndTheSeed) {
  const SweepManifest manifest = small_manifest();
  EXPECT_THAT(overrides_of(manifest, manifest.runs[1]), ElementsAre("time_limit_s=9", "a=2", "seed=1"));
}

TEST(Manifest, WhatIsNotOneIsRefusedByName) {
  EXPECT_THAT(message_of("{"), HasSubstr("sweep.json"));
  EXPECT_THAT(message_of("{}"), HasSubstr("version"));
  EXPECT_THAT(message_of("{\"version\": 1}"), HasSubstr("must be 2"));
  EXPECT_THAT(message_of("{\"version\": 2}"), HasSubstr("kind"));
}

TEST(Manifest, OneWithNothingToCompareIsRefused) {
  const test::TemporaryFolder folder;
  SweepManifest manifest = small_manifest();
  manifest.metrics.clear();
  save_manifest(folder / "a.json", manifest);
  EXPECT_THROW(load_manifest(folder / "a.json"), InputError);
  manifest = small_manifest();
  manifest.seeds.clear();
  manifest.runs.clear();
  save_manifest(folder / "a.json", manifest);
  EXPECT_THROW(load_manifest(folder / "a.json"), InputError);
}

}  // namespace
}  // namespace patrol::app::manifest_test
