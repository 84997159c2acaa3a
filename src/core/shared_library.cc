#include "core/shared_library.h"

#include <dlfcn.h>

namespace patrol {

SharedLibrary::SharedLibrary(const std::string& name, Scope scope)
    : handle_(::dlopen(name.c_str(), RTLD_NOW | (scope == Scope::kGlobal ? RTLD_GLOBAL : RTLD_LOCAL))) {
  if (handle_ == nullptr) error_ = ::dlerror();
}

void* SharedLibrary::find(const char* name) const { return is_loaded() ? ::dlsym(handle_, name) : nullptr; }

}  // namespace patrol
