#include "muslin/io/file_bytes.hpp"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& problem, int code,
                         const std::string& remedy) {
  const std::string reason = code == 0 ? "" : ": " + std::generic_category().message(code);
  throw Error(ErrorKind::file, Place{path.string()}, problem + reason, remedy);
}

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }
  /// Closing can be the first to tell of a failed write.
  bool close() {
    const int number = number_;
    number_ = -1;
    return ::close(number) == 0;
  }

 private:
  int number_;
};

const char* remedy_for(int code) {
  switch (code) {
    case ENOENT:
      return "check the path";
    case EACCES:
    case EPERM:
      return "check the permissions";
    case ENOSPC:
    case EDQUOT:
      return "free some space or write elsewhere";
    case EROFS:
      return "write elsewhere";
    default:
      return "check the path and the disk";
  }
}

bool write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

}  // namespace

std::string read_bytes(const std::filesystem::path& path) {
  // Not blocking, or opening a pipe that nobody writes to would wait for ever.
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.number() < 0) {
    const int code = errno;
    refuse(path, "cannot be read", code, remedy_for(code));
  }
  struct stat status {};
  if (::fstat(file.number(), &status) != 0) refuse(path, "cannot be read", errno, "check the disk");
  if (S_ISDIR(status.st_mode)) refuse(path, "is a folder", 0, "name a file in it");
  if (!S_ISREG(status.st_mode)) refuse(path, "is not a regular file", 0, "copy the data to a file first");
  std::string bytes;
  try {
    bytes.resize(static_cast<std::size_t>(status.st_size));
  } catch (const std::exception&) {
    refuse(path, "is too large for this machine's memory", 0, "split the mesh");
  }
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::read(file.number(), bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) refuse(path, "cannot be read", errno, "check the disk");
    if (count == 0) break;  // cut while we read it
    done += static_cast<std::size_t>(count);
  }
  bytes.resize(done);
  return bytes;
}

void write_bytes(const std::filesystem::path& path, std::string_view bytes) {
  static std::atomic<unsigned> serial{0};
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode))
    refuse(path, S_ISDIR(status.st_mode) ? "is a folder" : "is not a regular file", 0,
           "name a file to write");
  std::filesystem::path temporary = path;
  temporary += ".part-" + std::to_string(::getpid()) + "-" + std::to_string(serial++);
  Descriptor file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (file.number() < 0) {
    const int code = errno;
    refuse(path, "cannot be written", code, remedy_for(code));
  }
  const bool written = write_all(file.number(), bytes) && ::fsync(file.number()) == 0 && file.close() &&
                       ::rename(temporary.c_str(), path.c_str()) == 0;
  if (!written) {
    const int code = errno;
    ::unlink(temporary.c_str());
    refuse(path, "cannot be written", code, remedy_for(code));
  }
}

}  // namespace muslin
