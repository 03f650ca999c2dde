#include "muslin/view/deflater.hpp"

#include <random>

#include <gtest/gtest.h>
#include <zlib.h>

namespace muslin {
namespace {

std::string inflated(const std::string& packed, std::size_t size) {
  std::string out(size, '\0');
  uLongf length = size;
  EXPECT_EQ(::uncompress(reinterpret_cast<Bytef*>(out.data()), &length,
                         reinterpret_cast<const Bytef*>(packed.data()), packed.size()),
            Z_OK);
  out.resize(length);
  return out;
}

TEST(Deflater, RoundTripIsExact) {
  std::mt19937 random(1);
  std::string content;
  Deflater deflater;
  for (int part = 0; part < 200; ++part) {
    std::string bytes;
    for (int i = 0; i < part * 40; ++i) bytes += static_cast<char>(random() % (part % 2 ? 256 : 3));
    deflater.append(bytes);
    content += bytes;
  }
  const std::string packed = deflater.finish();
  EXPECT_LT(packed.size(), content.size());
  EXPECT_TRUE(inflated(packed, content.size()) == content);
}

TEST(Deflater, HandlesEmptyInput) { EXPECT_EQ(inflated(Deflater().finish(), 1), ""); }

TEST(Base64, AgreesWithTheStandard) {
  // RFC 4648, section 10.
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfb"), "//77");
}

}  // namespace
}  // namespace muslin
