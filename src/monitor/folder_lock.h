#pragma once

#include <filesystem>

namespace patrol::monitor {

/// Exclusive lock of a folder by one process, released when the process ends.
class FolderLock {
 public:
  /// Creates the folder if needed. Throws InputError on failure, or when another process holds the lock.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int file_ = -1;
};

}  // namespace patrol::monitor
