#include "muslin/cache/directory_lock.hpp"

#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "muslin/core/system_error.hpp"

namespace muslin {

namespace fs = std::filesystem;

DirectoryLock::DirectoryLock(const fs::path& directory, std::string_view name) {
  const fs::path path = directory / name;
  descriptor_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) throw system_error(path, "open", errno);
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  const int code = errno;
  ::close(std::exchange(descriptor_, -1));
  if (code != EWOULDBLOCK) throw system_error(path, "lock", code);
  throw Error(ErrorKind::file, {directory.string()}, "another process is writing this run",
              "wait for it or choose another directory with -o");
}

DirectoryLock::~DirectoryLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool DirectoryLock::is_held(const fs::path& directory, std::string_view name) {
  const int descriptor = ::open((directory / name).c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool held = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  return held;
}

DirectoryLock::DirectoryLock(DirectoryLock&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

DirectoryLock& DirectoryLock::operator=(DirectoryLock&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

}  // namespace muslin
