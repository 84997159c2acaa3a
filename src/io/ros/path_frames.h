#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace patrol::io {

/// Returns the frames that a nav_msgs/Path names: that of its header, then those of its poses, each once. Throws
/// DecodeError.
std::vector<std::string> path_frames_of(std::string_view bytes);

}  // namespace patrol::io
