// PNG files hold what was drawn, and a disk that is full leaves the old file alone.
#include "muslin/render/image.hpp"

#include <csignal>
#include <filesystem>

#include "render/scenes.hpp"
#include <gtest/gtest.h>
#include <png.h>
#include <sys/resource.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

using testing::Folder;

Image rainbow(int width, int height) {
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      image.pixel(x, y)[0] = static_cast<std::uint8_t>(x * 7 + y);
      image.pixel(x, y)[1] = static_cast<std::uint8_t>(y * 5);
      image.pixel(x, y)[2] = static_cast<std::uint8_t>(x * y);
    }
  return image;
}

TEST(Image, PngReadsBackAsWritten) {
  const Folder folder;
  const Image image = rainbow(37, 23);
  write_png(folder / "a.png", image);
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&png, (folder / "a.png").c_str()));
  EXPECT_EQ(png.width, 37u);
  EXPECT_EQ(png.height, 23u);
  png.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(png));
  ASSERT_TRUE(png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr));
  EXPECT_EQ(pixels, image.pixels);
}

TEST(Image, MissingFolderIsAFileError) {
  const Folder folder;
  try {
    write_png(folder / "none/a.png", rainbow(4, 4));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::file);
    EXPECT_NE(std::string(error.what()).find("a.png"), std::string::npos);
  }
}

TEST(Image, FullDiskKeepsTheOldFile) {
  const Folder folder;
  write_png(folder / "a.png", rainbow(4, 4));
  const std::string before = testing::read_text(folder / "a.png");
  // A limit on file sizes fails writes half way, as a full disk does.
  rlimit limit{};
  getrlimit(RLIMIT_FSIZE, &limit);
  rlimit small = limit;
  small.rlim_cur = 4096;
  const auto old = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  ErrorKind kind = ErrorKind::usage;
  try {
    write_png(folder / "a.png", rainbow(300, 300));
  } catch (const Error& error) {
    kind = error.kind();
  }
  setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, old);
  EXPECT_EQ(kind, ErrorKind::file);
  EXPECT_EQ(testing::read_text(folder / "a.png"), before);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.png.part"));
}

TEST(Image, SizesOutOfRangeAreRefused) {
  EXPECT_THROW(Image(0, 10), Error);
  EXPECT_THROW(Image(10, -1), Error);
  EXPECT_THROW(Image(20000, 10), Error);
}

}  // namespace
}  // namespace muslin
