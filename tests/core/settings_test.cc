#include "core/settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patrol::settings_test {
namespace {

struct Wheel {
  double radius_m = 0.1;
  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("radius_m", self.radius_m, between(0.01, 1.0));
  }
};

struct Cart {
  std::string color = "red";
  int seats = 2;
  bool is_loaded = false;
  std::uint64_t seed = 1;
  std::vector<double> loads_kg = {1.0, 2.0};
  std::vector<std::string> tags = {};
  Wheel spare = {};
  std::vector<Wheel> wheels = std::vector<Wheel>(2);
  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("color", self.color, one_of({"red", "green"}));
    visit("seats", self.seats, at_least(1));
    visit("is_loaded", self.is_loaded);
    visit("seed", self.seed);
    visit("loads_kg", self.loads_kg, at_least(0.0));
    visit("tags", self.tags);
    visit("spare", self.spare);
    visit("wheels", self.wheels);
  }
};

std::string complaint_about(const Cart& cart, const std::string& prefix = "") {
  try {
    validate(cart, prefix);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Validate, AcceptsTheDefaults) { EXPECT_EQ(complaint_about({}), ""); }

TEST(Validate, NamesFieldValueAndRule) {
  EXPECT_EQ(complaint_about({.seats = 0}), "seats = 0: must be at least 1");
  EXPECT_EQ(complaint_about({.color = "blue"}, "cart"), "cart.color = blue: must be one of red, green");
}

TEST(Validate, WalksIntoSectionsAndLists) {
  EXPECT_EQ(complaint_about({.spare = {.radius_m = 2.0}}, "cart"), "cart.spare.radius_m = 2: must be in [0.01, 1]");
  EXPECT_EQ(complaint_about({.wheels = {{}, {.radius_m = 0.0}}}), "wheels.1.radius_m = 0: must be in [0.01, 1]");
  EXPECT_EQ(complaint_about({.loads_kg = {0.0, -1.0}}), "loads_kg.1 = -1: must be at least 0");
}

TEST(Validate, RefusesWhatIsNotFiniteEvenWithoutARule) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  EXPECT_THAT(complaint_about({.loads_kg = {nan}}), ::testing::StartsWith("loads_kg.0 = nan: "));
  EXPECT_THAT(complaint_about({.loads_kg = {infinity}}), ::testing::StartsWith("loads_kg.0 = inf: "));
  EXPECT_FALSE(allows(any(), nan));
  EXPECT_EQ(describe_limits(any()), "must be finite");
}

TEST(Limits, AreClosedIntervals) {
  EXPECT_TRUE(allows(between(1.0, 2.0), 1.0));
  EXPECT_TRUE(allows(between(1.0, 2.0), 2.0));
  EXPECT_FALSE(allows(between(1.0, 2.0), 2.0 + 1e-15));
  EXPECT_EQ(describe_limits({.max = 3.0, .allowed = {}}), "must be at most 3");
}

TEST(InputErrorText, HasFileAndLineWhereThereIsOne) {
  EXPECT_STREQ(input_error("a.yaml", 12, "seats: too few").what(), "a.yaml:12: seats: too few");
  EXPECT_STREQ(input_error("a.yaml", 0, "seats: too few").what(), "a.yaml: seats: too few");
}

}  // namespace
}  // namespace patrol::settings_test
