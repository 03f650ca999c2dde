// Writes files and checks the result of every system call, including close.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

#include "muslin/api.hpp"

namespace muslin {

/// A file being written. All errors are Error(file) naming the path. Not copyable; closes when destroyed
/// (then without a check: call close()).
class MUSLIN_API OutputFile {
 public:
  enum class Mode {
    replace,  ///< new or emptied
    resume,   ///< existing content kept; written from its end
  };
  OutputFile() = default;
  OutputFile(std::filesystem::path path, Mode mode);
  ~OutputFile();
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&& other) noexcept;

  const std::filesystem::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }
  void append(const void* data, std::size_t bytes);
  void append(std::string_view text) { append(text.data(), text.size()); }
  /// Overwrites bytes that are already there.
  void write_at(std::uint64_t offset, const void* data, std::size_t bytes);
  /// Cuts the file off after `bytes`.
  void truncate(std::uint64_t bytes);
  /// Waits until the content is on the disk.
  void sync();
  void close();

 private:
  void write_all(std::uint64_t offset, const void* data, std::size_t bytes);
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// A file that appears under its name only when it is complete: it is written as NAME.part beside it and
/// renamed. A link is followed; files that are not regular are refused. Errors: file.
class MUSLIN_API WholeFile {
 public:
  explicit WholeFile(std::filesystem::path path);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;
  OutputFile& file() { return file_; }
  void append(const void* data, std::size_t bytes) { file_.append(data, bytes); }
  void append(std::string_view text) { file_.append(text); }
  void commit();

 private:
  std::filesystem::path path_;
  OutputFile file_;
  bool committed_ = false;
};

/// Writes to a temporary file beside `path` and renames it: readers see the old content or the new, never a
/// part. With `durable` the new content is on the disk before the old one is removed.
MUSLIN_API void write_atomically(const std::filesystem::path& path, std::string_view content,
                                 bool durable = true);

/// Creates a directory and its parents. Errors: file.
MUSLIN_API void make_directory(const std::filesystem::path& path);

}  // namespace muslin
