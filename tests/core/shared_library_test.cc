#include "core/shared_library.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patrol {
namespace {

TEST(SharedLibrary, FindsTheFunctionsOfALibraryByName) {
  const SharedLibrary math("libm.so.6");
  ASSERT_TRUE(math.is_loaded()) << math.error();
  const auto square_root = reinterpret_cast<double (*)(double)>(math.find("sqrt"));
  ASSERT_NE(square_root, nullptr);
  EXPECT_EQ(square_root(2.25), 1.5);
  EXPECT_EQ(math.find("no_such_function"), nullptr);
}

TEST(SharedLibrary, AMissingLibraryIsNamedAndHasNoFunctions) {
  const SharedLibrary missing("libpatrol_missing.so.1");
  EXPECT_FALSE(missing.is_loaded());
  EXPECT_THAT(missing.error(), testing::HasSubstr("libpatrol_missing.so.1"));
  EXPECT_EQ(missing.find("sqrt"), nullptr);
}

}  // namespace
}  // namespace patrol
