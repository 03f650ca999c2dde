// DirectoryLock allows one writer of a directory at a time.
#pragma once

#include <filesystem>
#include <string_view>

namespace muslin {

/// Holds the lock until destroyed or until the process ends, even if it crashes.
class DirectoryLock {
 public:
  DirectoryLock() = default;
  /// Locks `directory`, which must exist, with the file `name` in it. Errors: file, if another process holds
  /// the lock.
  DirectoryLock(const std::filesystem::path& directory, std::string_view name);
  ~DirectoryLock();
  /// True if another process holds it now.
  static bool is_held(const std::filesystem::path& directory, std::string_view name);
  DirectoryLock(DirectoryLock&& other) noexcept;
  DirectoryLock& operator=(DirectoryLock&& other) noexcept;

 private:
  int descriptor_ = -1;
};

}  // namespace muslin
