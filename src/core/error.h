#pragma once

#include <stdexcept>
#include <string>

namespace patrol {

/// Invalid input or invalid call. The message is one sentence with the place (file, line, key), the value and the rule.
/// The program prints it and exits with status 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(message) {}
};

/// Returns an InputError with the message "worlds/x.yaml:12: sensors.lidar: what is wrong". Line 0: no line number.
inline InputError input_error(const std::string& file, int line, const std::string& what) {
  return InputError(line > 0 ? file + ":" + std::to_string(line) + ": " + what : file + ": " + what);
}

}  // namespace patrol
