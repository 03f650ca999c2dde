// Movies have the frames, size and rate asked for; failures leave a message and no broken file.
#include "muslin/render/movie.hpp"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "render/scenes.hpp"
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

using testing::Folder;

Image moving(int frame, int width, int height) {
  Image image(width, height, {230, 230, 235});
  for (int y = 10; y < 20; ++y)
    for (int x = 2 * frame; x < 2 * frame + 10; ++x) image.pixel(x, y)[1] = 0;
  return image;
}

std::string output_of(const std::string& command) {
  std::string text;
  std::FILE* pipe = popen(command.c_str(), "r");
  for (int c; pipe && (c = std::fgetc(pipe)) != EOF;) text.push_back(static_cast<char>(c));
  if (pipe) pclose(pipe);
  return text;
}

bool have_ffmpeg() { return std::system("ffprobe -version >/dev/null 2>&1") == 0; }

int files_in(const Folder& folder) {
  int count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder.path())) ++count;
  return count;
}

TEST(Movie, HasTheFramesTheSizeAndTheRate) {
  if (!have_ffmpeg()) GTEST_SKIP() << "needs ffmpeg and ffprobe";
  const Folder folder;
  const auto path = folder / "a b's.mp4";  // no shell reads the name
  double last = 0;
  Progress progress;
  progress.report = [&](double fraction, std::string_view) { last = fraction; };
  write_movie(path, 13, [](int frame) { return moving(frame, 81, 45); }, {.frame_rate = 25}, progress);
  EXPECT_EQ(last, 1);
  EXPECT_EQ(output_of("ffprobe -v error -count_frames -show_entries "
                      "stream=codec_name,width,height,pix_fmt,r_frame_rate,nb_read_frames -of csv=p=0 \"" +
                      path.string() + "\""),
            "h264,82,46,yuv420p,25/1,13\n");
  // The index stands before the pictures, so that a browser can start at once.
  const std::string bytes = testing::read_text(path);
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat"));
  EXPECT_EQ(files_in(folder), 1);
}

TEST(Movie, MissingProgramIsAFileErrorWithARemedy) {
  const Folder folder;
  try {
    Movie movie(folder / "a.mp4", 32, 32, {.program = "no-such-ffmpeg"});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::file);
    EXPECT_NE(error.remedy().find("apt install ffmpeg"), std::string::npos);
  }
}

TEST(Movie, ProgramThatDiesIsAFileErrorWithoutASignal) {
  const Folder folder;
  Movie movie(folder / "a.mp4", 640, 480, {.program = "false"});
  const Image image(640, 480);
  EXPECT_THROW(
      {
        for (int frame = 0; frame < 50; ++frame) movie.add(image);
        movie.finish();
      },
      Error);
  EXPECT_EQ(files_in(folder), 0);
}

TEST(Movie, CancellingLeavesNothingBehind) {
  if (!have_ffmpeg()) GTEST_SKIP() << "needs ffmpeg";
  const Folder folder;
  int drawn = 0;
  Progress progress;
  progress.cancelled = [&] { return drawn == 4; };
  const auto draw = [&](int frame) {
    ++drawn;
    return moving(frame, 64, 48);
  };
  EXPECT_THROW(write_movie(folder / "a.mp4", 10, draw, {}, progress), Error);
  EXPECT_EQ(drawn, 4);
  EXPECT_EQ(files_in(folder), 0);
}

TEST(Movie, BadOptionsAndPlacesAreErrors) {
  const Folder folder;
  EXPECT_THROW(Movie(folder / "none/a.mp4", 32, 32), Error);
  EXPECT_THROW(Movie(folder / "a.mp4", 32, 32, {.frame_rate = 0}), Error);
  EXPECT_THROW(Movie(folder / "a.mp4", 32, 32, {.quality = 60}), Error);
  EXPECT_THROW(Movie(folder / "a.mp4", 0, 32), Error);
  EXPECT_THROW(write_movie(folder / "a.mp4", 0, [](int) { return Image(2, 2); }), Error);
  Movie movie(folder / "a.mp4", 32, 32, {.program = "cat"});
  EXPECT_THROW(movie.add(Image(32, 30)), Error);
}

TEST(Movie, FramesArePngFiles) {
  const Folder folder;
  write_frames(folder / "frames/here", 3, [](int frame) { return moving(frame, 40, 30); });
  for (const char* name : {"frame_0000.png", "frame_0001.png", "frame_0002.png"})
    EXPECT_EQ(testing::read_text(folder / ("frames/here/" + std::string(name))).substr(1, 3), "PNG");
}

}  // namespace
}  // namespace muslin
