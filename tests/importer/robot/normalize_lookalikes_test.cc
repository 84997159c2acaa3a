#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/importer/robot/description.h"
#include "tests/importer/robot/import.h"

namespace patrol::importer::normalize_lookalikes_test {
namespace {

using ::testing::MatchesRegex;

/// Message of a refused description; empty if it is accepted.
std::string refusal(const std::string& text, const std::set<std::string>& casters = {}) {
  Import import(text);
  import.options.casters = casters;
  return complaint(import);
}

/// Four wheels; the joint of the front left one has this type and axis, and its link this height.
std::string four_wheels(const std::string& type, const std::string& direction, const std::string& z = "-0.05") {
  std::string text = chassis() + wheel("fl", "base_link", "0.2 0.25 " + z, 0.1, 0.04, kMotor, direction);
  text.replace(text.find("continuous"), 10, type);
  return robot(text + wheel("fr", "base_link", "0.2 -0.25 -0.05", 0.1, 0.04) +
               wheel("rl", "base_link", "-0.2 0.25 -0.05", 0.1, 0.04) +
               wheel("rr", "base_link", "-0.2 -0.25 -0.05", 0.1, 0.04));
}

TEST(WheelFinder, OneOfFourWheelsThatDoesNotTurnAboutItsAxleIsRefusedUnlessItIsACasterByOption) {
  EXPECT_EQ(refusal(four_wheels("continuous", "0 1 0")), "");
  for (const char* direction : {"0 0 1", "1 0 0", "0.1 1 0"}) {
    EXPECT_THAT(
        refusal(four_wheels("continuous", direction)),
        MatchesRegex("vendor.urdf:4: fl: touches the ground like wheel [fr][lr], .*, but joint fl_joint does not turn "
                     "it about its axle: a wheel must turn about its axle; --caster fl if it slides"));
  }
  EXPECT_THAT(refusal(four_wheels("fixed", "0 1 0")),
              MatchesRegex("vendor.urdf:4: fl: touches the ground like .*, but joint fl_joint is fixed: .*"));
  EXPECT_EQ(refusal(four_wheels("fixed", "0 1 0"), {"fl"}), "");
  EXPECT_EQ(refusal(four_wheels("fixed", "0 1 0"), {"nothing"}), "vendor.urdf: caster nothing: unknown link");
}

TEST(WheelFinder, OneWheelBelowTheOthersIsNamed) {
  EXPECT_EQ(refusal(four_wheels("continuous", "0 1 0", "-0.08")),
            "vendor.urdf:4: fl: is 0.030 m below the other wheels: all wheels must touch one plane");
  EXPECT_EQ(refusal(four_wheels("continuous", "0 1 0", "-0.02")),
            "vendor.urdf:4: fl: is 0.030 m above the lowest wheel: all wheels must touch one plane");
}

}  // namespace
}  // namespace patrol::importer::normalize_lookalikes_test
