#include "muslin/core/input_file.hpp"

#include <cerrno>
#include <exception>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "muslin/core/system_error.hpp"

namespace muslin {
namespace {

struct Descriptor {
  explicit Descriptor(int descriptor) : number(descriptor) {}
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number;
};

}  // namespace

std::string read_file(const std::filesystem::path& path, std::uint64_t max_bytes) {
  const auto refuse = [&path](const std::string& problem, const std::string& remedy) -> Error {
    return {ErrorKind::file, {path.string()}, problem, remedy};
  };
  // Non-blocking, since opening a pipe without a writer would wait forever.
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.number < 0) throw system_error(path, "read", errno);
  struct stat status{};
  if (::fstat(file.number, &status) != 0) throw system_error(path, "read", errno);
  if (S_ISDIR(status.st_mode)) throw refuse("is a folder", "name a file in it");
  if (!S_ISREG(status.st_mode)) throw refuse("is not a regular file", "copy the data to a file first");
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (size > max_bytes) {
    throw refuse("is larger than " + std::to_string(max_bytes >> 20) + " MiB",
                 "check that it is the right file");
  }
  std::string bytes;
  try {
    bytes.resize(size);
  } catch (const std::exception&) {
    throw refuse("is too large for this machine's memory", "use a smaller file");
  }
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = ::read(file.number, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw system_error(path, "read", errno);
    if (count == 0) break;  // truncated during reading
    done += static_cast<std::size_t>(count);
  }
  bytes.resize(done);
  return bytes;
}

}  // namespace muslin
