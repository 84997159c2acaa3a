#pragma once

namespace patrol::io {

/// Returns a function of libav (FFmpeg). Its libraries are loaded by the first call: with the 130 libraries that they
/// need, that takes as long as the rest of the start of the program. Throws std::runtime_error if they are not
/// installed.
void* find_libav_function(const char* name);

template <typename Function>
Function* libav_function(const char* name) {
  return reinterpret_cast<Function*>(find_libav_function(name));
}

}  // namespace patrol::io

/// Function of libav that a header of libav declares.
#define PATROL_LIBAV(name) (::patrol::io::libav_function<decltype(name)>(#name))
