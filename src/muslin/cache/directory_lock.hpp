// DirectoryLock allows one writer of a directory at a time.
#pragma once

#include <filesystem>
#include <string_view>

namespace muslin {

/// Holds a directory for one process until destroyed or the process ends, however it ends.
class DirectoryLock {
 public:
  DirectoryLock() = default;
  /// Error(file) if another process holds it; `directory` must exist. The lock is the file `name` in it.
  DirectoryLock(const std::filesystem::path& directory, std::string_view name);
  ~DirectoryLock();
  DirectoryLock(DirectoryLock&& other) noexcept;
  DirectoryLock& operator=(DirectoryLock&& other) noexcept;

 private:
  int descriptor_ = -1;
};

}  // namespace muslin
