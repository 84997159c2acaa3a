#pragma once

#include <cerrno>
#include <stdexcept>
#include <string>

namespace patrol::io {

/// Output that cannot be written although its folder exists: the disk is full or fails. It is a failure of the
/// environment and not of the input: the same command succeeds later.
class OutputError : public std::runtime_error {
 public:
  explicit OutputError(const std::string& message) : std::runtime_error(message) {}
};

/// Returns whether an error number states that there is no space left.
inline bool is_out_of_space(int error) { return error == ENOSPC || error == EDQUOT; }

}  // namespace patrol::io
