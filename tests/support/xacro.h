#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace patrol::test {

/// Returns whether xacro is installed, in the interpreter of the tests that tools/setup makes or in another.
inline bool has_xacro() {
  const std::string python = PATROL_SOURCE_DIR "/.deps/python/bin/python";
  if (std::filesystem::exists(python)) ::setenv("PATROL_PYTHON", python.c_str(), 0);
  return std::system("${PATROL_PYTHON:-python3} -c 'import xacro' 2> /dev/null") == 0;
}

}  // namespace patrol::test
