#pragma once

#include <filesystem>

namespace patrol::monitor {

/// One process at a time may hold a folder. It lets go when it dies.
class FolderLock {
 public:
  /// Makes the folder when it is not there. Throws InputError when it cannot, or another process holds it.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int file_ = -1;
};

}  // namespace patrol::monitor
