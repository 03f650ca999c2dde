#include "muslin/view/zip_archive.hpp"

#include <gtest/gtest.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

// That archives are read by others is tested with Python's zipfile, on what `muslin blender-addon` writes.
TEST(ZipArchive, AnEmptyArchiveIsItsEnd) {
  EXPECT_EQ(ZipArchive().finish(), std::string("PK\5\6") + std::string(18, '\0'));
}

TEST(ZipArchive, TheSameFilesGiveTheSameBytes) {
  const auto packed = [](bool executable) {
    ZipArchive archive;
    archive.add("a/b.txt", std::string(1000, 'x'), executable);
    return archive.finish();
  };
  EXPECT_EQ(packed(false), packed(false));
  EXPECT_NE(packed(false), packed(true));
  EXPECT_LT(packed(false).size(), 200u);
}

TEST(ZipArchive, RefusesWhatTheFormatCannotName) {
  ZipArchive archive;
  EXPECT_THROW(archive.add(std::string(70000, 'n'), "x"), Error);
}

}  // namespace
}  // namespace muslin
