#include "render/video/inspect_video.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace patrol::render::inspect_video_test {
namespace {

TEST(InspectVideo, NamesAFileThatCannotBeRead) { EXPECT_THROW(inspect_video("/nowhere/at/all/film.mp4"), InputError); }

}  // namespace
}  // namespace patrol::render::inspect_video_test
