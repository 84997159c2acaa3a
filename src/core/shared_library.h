#pragma once

#include <string>

namespace patrol {

/// Shared library that is loaded where it is used, so that other uses of the program do not wait for it. It stays
/// loaded until the process ends.
class SharedLibrary {
 public:
  enum class Scope {
    kLocal,   ///< found by `find` alone
    kGlobal,  ///< found by the other libraries of the process as well
  };

  /// `name`: soname, as libEGL.so.1.
  explicit SharedLibrary(const std::string& name, Scope scope = Scope::kLocal);

  bool is_loaded() const { return handle_ != nullptr; }
  /// Returns why the library is not loaded.
  const std::string& error() const { return error_; }
  /// Returns a function of the library or of the libraries that it needs; null if there is none.
  void* find(const char* name) const;

 private:
  void* handle_;
  std::string error_;
};

}  // namespace patrol
