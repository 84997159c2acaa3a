#include "monitor/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <system_error>

#include <fmt/format.h>

#include "core/error.h"

namespace patrol::monitor {

FolderLock::FolderLock(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw InputError(fmt::format("{}: cannot create the directory: {}", folder.string(), error.message()));
  file_ = ::open((folder / "lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (file_ < 0) throw InputError(fmt::format("{}: cannot write", folder.string()));
  if (::flock(file_, LOCK_EX | LOCK_NB) == 0) return;
  ::close(file_);
  throw InputError(fmt::format("{}: in use by another patrol monitor", folder.string()));
}

FolderLock::~FolderLock() { ::close(file_); }

}  // namespace patrol::monitor
