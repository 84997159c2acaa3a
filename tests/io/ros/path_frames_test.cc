#include "io/ros/path_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/io/sample_messages.h"

namespace patrol::io::path_frames_test {
namespace {

using ::testing::ElementsAre;

TEST(PathFramesOf, AreThoseOfTheHeaderAndOfThePosesEachOnce) {
  std::string path = encode(Path{.stamp = test::kSampleStamp, .T_map_body = {{}, {}, {}}});
  EXPECT_THAT(path_frames_of(path), ElementsAre("map"));
  path.replace(path.rfind("map"), 3, "odo");
  EXPECT_THAT(path_frames_of(path), ElementsAre("map", "odo"));
  path.replace(path.find("map"), 3, "bad");
  EXPECT_THAT(path_frames_of(path), ElementsAre("bad", "map", "odo"));
  EXPECT_THROW(path_frames_of(path.substr(0, path.size() - 1)), DecodeError);
}

}  // namespace
}  // namespace patrol::io::path_frames_test
