#pragma once

#include <string>
#include <vector>

#include "app/check/run_check.h"

namespace patrol::app {

/// Picture of a check drive.
struct CheckPicture {
  std::string png;
  std::string caption;
};

/// Renders the pictures of the maneuvers off-screen. Throws std::runtime_error without OpenGL.
std::vector<CheckPicture> render_check_pictures(const CheckResult& result);

}  // namespace patrol::app
