#include "io/images/libav_function.h"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patrol::io {
namespace {

TEST(LibavFunction, IsFoundInEachOfTheFourLibraries) {
  for (const char* name : {"avformat_version", "avcodec_version", "avutil_version", "swscale_version"}) {
    const unsigned version = libav_function<unsigned()>(name)();
    EXPECT_GT(version >> 16U, 0U) << name;  // major version
  }
}

TEST(LibavFunction, AFunctionThatDoesNotExistIsNamed) {
  EXPECT_THAT([] { find_libav_function("avcodec_missing"); },
              testing::ThrowsMessage<std::runtime_error>("libav: has no function avcodec_missing"));
}

}  // namespace
}  // namespace patrol::io
