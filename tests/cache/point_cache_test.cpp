// Point caches byte by byte: golden headers, and values read back by a reader of the test's own.
#include "muslin/cache/point_cache.hpp"

#include <cstring>

#include "cache/scratch.hpp"

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

using test::bytes_of;
using test::Scratch;

std::string golden(std::initializer_list<int> bytes) {
  std::string text;
  for (int byte : bytes) text += static_cast<char>(byte);
  return text;
}

const std::vector<Vec3> one = {{1, 2, 3}, {-0.5, 0, 1e-3}};
const std::vector<Vec3> two = {{4, 5, 6}, {7, 8, 9}};

TEST(PointCache, Pc2HasTheBytesOfTheFormat) {
  Scratch scratch;
  Pc2Writer writer(scratch / "a.pc2", 2, OutputFile::Mode::replace);
  writer.append(one);
  writer.append(two);
  writer.close();
  const std::string bytes = bytes_of(scratch / "a.pc2");
  ASSERT_EQ(bytes.size(), 32u + 2 * 2 * 12);
  EXPECT_EQ(bytes.substr(0, 32),
            std::string("POINTCACHE2\0", 12) +
                golden({1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x80, 0x3f, 2, 0, 0, 0}));
  EXPECT_EQ(bytes.substr(32, 12), golden({0, 0, 0x80, 0x3f, 0, 0, 0, 0x40, 0, 0, 0x40, 0x40}));
  float last = 0;
  std::memcpy(&last, bytes.data() + bytes.size() - 4, 4);
  EXPECT_EQ(last, 9.0f);
}

TEST(PointCache, Pc2HeaderNeverCountsUnwrittenSamples) {
  Scratch scratch;
  Pc2Writer writer(scratch / "a.pc2", 2, OutputFile::Mode::replace);
  EXPECT_EQ(Pc2Reader(scratch / "a.pc2").samples(), 0);
  writer.append(one);
  EXPECT_EQ(Pc2Reader(scratch / "a.pc2").samples(), 1);
  writer.append(two);
  EXPECT_EQ(Pc2Reader(scratch / "a.pc2").samples(), 2);
  EXPECT_EQ(Pc2Reader(scratch / "a.pc2").read(1)[1], Vec3f(7, 8, 9));
  EXPECT_EQ(Pc2Reader(scratch / "a.pc2").read(0)[1], Vec3f(-0.5f, 0, 1e-3f));
}

TEST(PointCache, TruncatedPc2IsReadAndRepaired) {
  Scratch scratch;
  {
    Pc2Writer writer(scratch / "a.pc2", 2, OutputFile::Mode::replace);
    for (int i = 0; i < 3; ++i) writer.append(one);
  }
  const std::string whole = bytes_of(scratch / "a.pc2");
  test::write_bytes(scratch / "a.pc2", whole.substr(0, whole.size() - 5));
  EXPECT_EQ(Pc2Reader(scratch / "a.pc2").samples(), 2);
  {
    Pc2Writer writer(scratch / "a.pc2", 2, OutputFile::Mode::resume, 2);
    EXPECT_EQ(Pc2Reader(scratch / "a.pc2").samples(), 2);
    writer.append(one);
  }
  EXPECT_EQ(bytes_of(scratch / "a.pc2"), whole);
  EXPECT_THROW(Pc2Writer(scratch / "a.pc2", 2, OutputFile::Mode::resume, 4), Error);
  EXPECT_THROW(Pc2Writer(scratch / "a.pc2", 3, OutputFile::Mode::resume, 1), Error);
}

TEST(PointCache, RefusesFilesThatAreNotPointCaches) {
  Scratch scratch;
  test::write_bytes(scratch / "text.pc2", std::string(100, 'x'));
  test::write_bytes(scratch / "short.pc2", "POINT");
  EXPECT_THROW(Pc2Reader(scratch / "text.pc2"), Error);
  EXPECT_THROW(Pc2Reader(scratch / "short.pc2"), Error);
  EXPECT_THROW(Pc2Reader(scratch / "missing.pc2"), Error);
}

TEST(PointCache, MddIsBigEndian) {
  Scratch scratch;
  write_mdd(scratch / "a.mdd", 2, 1, 24,
            [](int frame) { return std::vector<Vec3f>{Vec3f(1, static_cast<float>(frame), -2)}; });
  const std::string bytes = bytes_of(scratch / "a.mdd");
  ASSERT_EQ(bytes.size(), 8u + 2 * 4 + 2 * 12);
  EXPECT_EQ(bytes.substr(0, 12), golden({0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0, 0}));
  EXPECT_EQ(bytes.substr(12, 4), golden({0x3d, 0x2a, 0xaa, 0xab}));  // 1/24 s
  EXPECT_EQ(bytes.substr(16, 4), golden({0x3f, 0x80, 0, 0}));
  EXPECT_EQ(bytes.substr(28, 12), golden({0x3f, 0x80, 0, 0, 0x3f, 0x80, 0, 0, 0xc0, 0, 0, 0}));
}

TEST(PointCache, AFullDiskIsAnErrorThatNamesTheFile) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
  try {
    OutputFile file("/dev/full", OutputFile::Mode::resume);
    file.append("some bytes");
    FAIL() << "written to a full disk";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::file);
    EXPECT_EQ(error.place().file, "/dev/full");
    EXPECT_NE(std::string(error.what()).find("No space left"), std::string::npos) << error.what();
  }
}

TEST(OutputFile, FailuresNameThePath) {
  Scratch scratch;
  test::write_bytes(scratch / "file", "x");
  for (const auto& path : {scratch / "file/below", scratch / "no/such/directory", scratch.path()}) {
    try {
      write_atomically(path, "content");
      FAIL() << path;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::file);
      EXPECT_EQ(error.place().file, path.string()) << error.what();
    }
  }
  EXPECT_EQ(bytes_of(scratch / "file"), "x");
}

TEST(OutputFile, AnUnfinishedFileLeavesTheOldOne) {
  Scratch scratch;
  write_atomically(scratch / "a", "old");
  {
    WholeFile file(scratch / "a");
    file.append("half of the ne");
  }
  EXPECT_EQ(bytes_of(scratch / "a"), "old");
  EXPECT_FALSE(std::filesystem::exists(scratch / "a.part"));
  write_atomically(scratch / "a", "new");
  EXPECT_EQ(bytes_of(scratch / "a"), "new");
}

}  // namespace
}  // namespace muslin
