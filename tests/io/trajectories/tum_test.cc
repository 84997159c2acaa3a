#include "io/trajectories/tum.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/pose_near.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::tum_test {
namespace {

using namespace std::chrono_literals;
using test::Pose3Near, test::TemporaryFile, test::TemporaryFolder;
using ::testing::EndsWith, ::testing::HasSubstr;

std::string complaint_about(const std::string& text) {
  const TemporaryFile file("a.tum", text);
  try {
    load_tum(file.path());
  } catch (const InputError& error) {
    const std::string what = error.what();
    return what.substr(what.find("a.tum"));
  }
  return "";
}

TEST(LoadTum, ReadsPosesAndSkipsComments) {
  const TemporaryFile file("a.tum", "# t x y z qx qy qz qw\n\n1.5 1 2 3 0 0 0 1\r\n  2.000000001 -1e1 0 0 0 0 1 0  \n");
  const Trajectory trajectory = load_tum(file.path());
  ASSERT_EQ(trajectory.size(), 2U);
  EXPECT_EQ(trajectory[0].stamp, Time(1500ms));
  EXPECT_EQ(trajectory[1].stamp, Time(2s + 1ns));
  EXPECT_THAT(trajectory[0].pose, Pose3Near((Pose3{{1.0, 2.0, 3.0}, {1.0, 0.0, 0.0, 0.0}}), 0.0, 1e-7));
  EXPECT_THAT(trajectory[1].pose, Pose3Near((Pose3{{-10.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 1.0}}), 0.0, 1e-7));
}

TEST(SaveTum, ThereAndBackKeepsNanosecondsAndMicrometres) {
  const TemporaryFolder folder;
  const Trajectory was = {{Time{1}, {{1.23456789, -2.0, 0.3}, quaternion_from_rpy(0.1, 0.2, 0.3)}},
                          {123456s + 789ns, {{1e5, 1e-9, 0.0}, quaternion_from_yaw(3.0)}}};
  save_tum(folder / "a.tum", was, "estimate in map");
  EXPECT_TRUE(test::read_bytes(folder / "a.tum").starts_with("# estimate in map\n"));
  const Trajectory is = load_tum(folder / "a.tum");
  ASSERT_EQ(is.size(), was.size());
  for (std::size_t i = 0; i < was.size(); ++i) {
    EXPECT_EQ(is[i].stamp, was[i].stamp);
    EXPECT_THAT(is[i].pose, Pose3Near(was[i].pose, 1e-8, 1e-6));
  }
}

TEST(LoadTum, WhatIsNoPoseIsNamedByItsLine) {
  const std::string good = "1 0 0 0 0 0 0 1\n";
  const std::string rule = ": a pose is t x y z qx qy qz qw";
  EXPECT_EQ(complaint_about(good + "2 0 0 0 0 0 0\n"), "a.tum:2: ends before qw" + rule);
  EXPECT_EQ(complaint_about(good + "2 0 0 0 0 0 0 1 9\n"), "a.tum:2: more than eight words" + rule);
  EXPECT_EQ(complaint_about("# c\n\n" + good + "2 0 nan 0 0 0 0 1\n"),
            "a.tum:4: position 'nan' is not a finite number" + rule);
  EXPECT_EQ(complaint_about(good + "2 0 inf 0 0 0 0 1\n"), "a.tum:2: position 'inf' is not a finite number" + rule);
  EXPECT_EQ(complaint_about("1,0,0,0,0,0,0,1\n"), "a.tum:1: t '1,0,0,0,0,0,0,1' is not a time in seconds" + rule);
}

TEST(LoadTum, NumbersOutOfRangeAreNamed) {
  EXPECT_THAT(complaint_about("1000000000000.5 0 0 0 0 0 0 1\n"),
              HasSubstr("a.tum:1: t '1000000000000.5' is out of range: must be at most 9e+09 s"));
  EXPECT_THAT(complaint_about("1 1e300 0 0 0 0 0 1\n"), HasSubstr("a.tum:1: position 1e+300 m is off the earth"));
}

TEST(LoadTum, StampsMustGrow) {
  EXPECT_EQ(complaint_about("2 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n"),
            "a.tum:2: stamp 2.000000000 does not follow 2.000000000: stamps must increase");
  EXPECT_THAT(complaint_about("2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"), HasSubstr("a.tum:2: stamp 1.0"));
}

TEST(LoadTum, OfPosesOfOneStampTheFirstMayBeKept) {
  const TemporaryFile file("a.tum", "1 5 0 0 0 0 0 1\n1 6 0 0 0 0 0 1\n2 7 0 0 0 0 0 1\n");
  std::size_t num_left_out = 0;
  const Trajectory trajectory = load_tum(file.path(), SameStamps::kKeepFirst, &num_left_out);
  ASSERT_EQ(trajectory.size(), 2U);
  EXPECT_EQ(num_left_out, 1U);
  EXPECT_EQ(trajectory[0].pose.position.x(), 5.0);
  EXPECT_EQ(trajectory[1].pose.position.x(), 7.0);
  const TemporaryFile falling("a.tum", "2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n");
  EXPECT_THROW(load_tum(falling.path(), SameStamps::kKeepFirst), InputError);
}

TEST(SaveTum, SecondsSinceNineteenSeventyComeBackToTheNanosecond) {
  const TemporaryFolder folder;
  const Trajectory was = {
      {Time(-1'500'000'000), {}}, {Time(976'052'857'222'433'000), {}}, {Time(976'052'857'222'433'001), {}}};
  save_tum(folder / "a.tum", was, "c");
  EXPECT_THAT(test::read_bytes(folder / "a.tum"), HasSubstr("\n-1.500000000 0.0"));
  EXPECT_THAT(test::read_bytes(folder / "a.tum"), HasSubstr("\n976052857.222433000 0.0"));
  const Trajectory is = load_tum(folder / "a.tum");
  for (std::size_t i = 0; i < was.size(); ++i) EXPECT_EQ(is[i].stamp, was[i].stamp);
}

TEST(LoadTum, AQuaternionOfLengthTwoIsRefusedAndFourDigitsAreEnough) {
  EXPECT_EQ(complaint_about("2 0 0 0 0 0 0 2\n"), "a.tum:1: the quaternion has length 2, must be 1");
  EXPECT_EQ(complaint_about("2 0 0 0 0 0 0.7071 0.7071\n"), "");
}

TEST(LoadTum, AnEmptyOrMissingFileIsRefused) {
  EXPECT_EQ(complaint_about("# nothing\n"), "a.tum: contains no poses");
  const TemporaryFolder folder;
  EXPECT_THROW(load_tum(folder / "missing.tum"), InputError);
}

}  // namespace
}  // namespace patrol::io::tum_test
