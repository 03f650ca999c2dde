// ZipArchive packs files into a zip archive in memory (PKWARE APPNOTE 6.3, without ZIP64).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace muslin {

/// The same files give the same bytes: their date is the first that the format has, 1 January 1980.
class ZipArchive {
 public:
  /// Adds a file by its path in the archive, with slashes, in UTF-8. With `executable` it may be executed
  /// once unpacked by a program that heeds permissions. Errors: usage, from 4 GB or 65535 files on.
  void add(std::string_view path, std::string_view bytes, bool executable = false);
  /// Ends the archive and returns it.
  std::string finish();

 private:
  std::string out_, directory_;
  std::uint32_t count_ = 0;
};

}  // namespace muslin
