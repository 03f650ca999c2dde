#include "muslin/core/output_file.hpp"

#include <cerrno>
#include <cstdio>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "muslin/core/system_error.hpp"

namespace muslin {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& action, int code) {
  throw system_error(path, action, code);
}

/// Returns the path of the file after following links.
fs::path target_of(const fs::path& path) {
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status)) return path;
  if (fs::is_directory(status)) fail(path, "write", EISDIR);
  if (!fs::is_regular_file(status))
    throw Error(ErrorKind::file, {path.string()}, "cannot write: not a regular file", "choose another name");
  const fs::path target = fs::canonical(path, code);
  return code ? path : target;
}

/// Renames are durable only once the directory is synced.
void sync_directory(const fs::path& directory) {
  const int descriptor =
      ::open(directory.empty() ? "." : directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) fail(directory, "open the directory", errno);
  // Some file systems cannot sync a directory and return EINVAL; their renames are durable by other means.
  if (::fsync(descriptor) != 0 && errno != EINVAL) {
    const int code = errno;
    ::close(descriptor);
    fail(directory, "flush the directory", code);
  }
  ::close(descriptor);
}

}  // namespace

OutputFile::OutputFile(fs::path path, Mode mode) : path_(std::move(path)) {
  const int flags = O_WRONLY | O_CREAT | O_CLOEXEC | (mode == Mode::replace ? O_TRUNC : 0);
  descriptor_ = ::open(path_.c_str(), flags, 0666);
  if (descriptor_ < 0) fail(path_, "open for writing", errno);
  struct stat status{};
  if (::fstat(descriptor_, &status) != 0) fail(path_, "look at", errno);
  size_ = static_cast<std::uint64_t>(status.st_size);
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)), size_(other.size_) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(size_, other.size_);
  return *this;
}

void OutputFile::write_all(std::uint64_t offset, const void* data, std::size_t bytes) {
  const auto* from = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t done = ::pwrite(descriptor_, from, bytes, static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done < 0) fail(path_, "write", errno);
    if (done == 0) fail(path_, "write", ENOSPC);
    from += done;
    offset += static_cast<std::uint64_t>(done);
    bytes -= static_cast<std::size_t>(done);
  }
}

void OutputFile::append(const void* data, std::size_t bytes) {
  try {
    write_all(size_, data, bytes);
  } catch (const Error&) {
    // Removes the partly written record.
    [[maybe_unused]] const int ignored = ::ftruncate(descriptor_, static_cast<off_t>(size_));
    throw;
  }
  size_ += bytes;
}

void OutputFile::write_at(std::uint64_t offset, const void* data, std::size_t bytes) {
  write_all(offset, data, bytes);
}

void OutputFile::truncate(std::uint64_t bytes) {
  if (::ftruncate(descriptor_, static_cast<off_t>(bytes)) != 0) fail(path_, "shorten", errno);
  size_ = bytes;
}

void OutputFile::sync() {
  if (::fsync(descriptor_) != 0 && errno != EINVAL) fail(path_, "flush", errno);
}

void OutputFile::close() {
  if (descriptor_ >= 0 && ::close(std::exchange(descriptor_, -1)) != 0) fail(path_, "close", errno);
}

WholeFile::WholeFile(fs::path path) : path_(target_of(path)) {
  fs::path temporary = path_;
  temporary += ".part";
  try {
    file_ = OutputFile(temporary, OutputFile::Mode::replace);
  } catch (const Error& error) {
    throw Error(error.kind(), {path_.string()}, error.problem(), error.remedy());
  }
}

WholeFile::~WholeFile() {
  if (committed_) return;
  std::error_code ignored;
  fs::remove(file_.path(), ignored);
}

void WholeFile::commit() {
  file_.close();
  if (std::rename(file_.path().c_str(), path_.c_str()) != 0) fail(path_, "replace", errno);
  committed_ = true;
}

void write_atomically(const fs::path& path, std::string_view content, bool durable) {
  WholeFile file(path);
  file.append(content);
  if (durable) file.file().sync();
  file.commit();
  if (durable) sync_directory(path.parent_path());
}

void make_directory(const fs::path& path) {
  std::error_code code;
  fs::create_directories(path, code);
  if (code) fail(path, "create the directory", code.value());
  if (!fs::is_directory(path)) fail(path, "create the directory", ENOTDIR);
}

}  // namespace muslin
