#include "core/letter_case.h"

#include <gtest/gtest.h>

namespace patrol::letter_case_test {
namespace {

TEST(ToLower, ChangesAsciiLettersOnly) { EXPECT_EQ(to_lower(".GlB_\xC3\x84"), ".glb_\xC3\x84"); }

}  // namespace
}  // namespace patrol::letter_case_test
