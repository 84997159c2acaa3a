#pragma once

#include <filesystem>
#include <vector>

#include "render/video/chapter.h"

namespace patrol::render {

/// Whether videos of this name can be joined: MP4.
bool can_join(const std::filesystem::path& file);

/// Joins videos of `VideoWriter` with equal settings into `out`, without encoding again, and adds the chapters. All but
/// the last have `frames_per_video` frames. A single video is moved if it cannot be joined. Throws InputError when a
/// file cannot be read or written.
void join_videos(const std::vector<std::filesystem::path>& videos, int frames_per_video,
                 const std::vector<Chapter>& chapters, const std::filesystem::path& out);

}  // namespace patrol::render
