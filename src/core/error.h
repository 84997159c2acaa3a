#pragma once

#include <stdexcept>
#include <string>

namespace patrol {

/// The input or the call was wrong: one sentence that names the place (file, line, key), the value and the rule.
/// The program prints it and exits with 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// "worlds/x.yaml:12: sensors.lidar: what is wrong". Line 0 means that the place has no line.
inline InputError input_error(const std::string& file, int line, const std::string& what) {
  return InputError(line > 0 ? file + ":" + std::to_string(line) + ": " + what : file + ": " + what);
}

}  // namespace patrol
