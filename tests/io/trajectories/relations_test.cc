#include "io/trajectories/relations.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/pose_near.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::relations_test {
namespace {

using test::Pose2Near, test::TemporaryFile;
using ::testing::EndsWith;

std::string complaint_about(const std::string& text) {
  const TemporaryFile file("a.relations", text);
  try {
    load_relations(file.path());
  } catch (const InputError& error) {
    const std::string what = error.what();
    return what.substr(what.find("a.relations"));
  }
  return "";
}

TEST(LoadRelations, ReadsStampsToTheNanosecondAndThePlanarPose) {
  const TemporaryFile file(
      "a.relations",
      "# t1 t2 x y z roll pitch yaw\n\n976052905.167303 976052911.885496 -0.056990 -0.128430 9 8 7 -1.682210\r\n"
      "2 1 0 0 0 0 0 7\n");
  const std::vector<PoseRelation> relations = load_relations(file.path());
  ASSERT_EQ(relations.size(), 2U);
  EXPECT_EQ(relations[0].from, Time(976'052'905'167'303'000));
  EXPECT_EQ(relations[0].to, Time(976'052'911'885'496'000));
  EXPECT_THAT(relations[0].T_from_to, Pose2Near(Pose2{-0.05699, -0.12843, -1.68221}, 0.0, 0.0));
  EXPECT_NEAR(relations[1].T_from_to.yaw, 7.0 - 2.0 * std::numbers::pi, 1e-15)
      << "wrapped; and the second may be the earlier";
}

TEST(LoadRelations, WhatIsNoRelationIsNamedByItsLine) {
  const std::string good = "1 2 0 0 0 0 0 0\n", rule = ": a relation is t1 t2 x y z roll pitch yaw";
  EXPECT_EQ(complaint_about(good + "1 2 0 0 0 0 0\n"), "a.relations:2: ends before yaw" + rule);
  EXPECT_EQ(complaint_about(good + "1 2 0 0 0 0 0 0 0\n"), "a.relations:2: more than eight numbers" + rule);
  EXPECT_EQ(complaint_about("#\n1 2 nan 0 0 0 0 0\n"), "a.relations:2: x 'nan' is not a finite number" + rule);
  EXPECT_EQ(complaint_about("1 t2 0 0 0 0 0 0\n"), "a.relations:1: t2 't2' is not a time in seconds" + rule);
  EXPECT_EQ(complaint_about(std::string(2'000'000, '1')), "a.relations:1: is too long" + rule);
}

TEST(LoadRelations, AnEmptyOrMissingFileIsRefused) {
  EXPECT_EQ(complaint_about("# none\n"), "a.relations: contains no relations");
  EXPECT_THROW(load_relations("/nowhere/a.relations"), InputError);
}

}  // namespace
}  // namespace patrol::io::relations_test
