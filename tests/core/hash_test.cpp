// The hash that checkpoints and fingerprints depend on.
#include "muslin/core/hash.hpp"

#include <string_view>

#include <gtest/gtest.h>

namespace muslin {
namespace {

std::uint64_t hash_of(std::string_view text, std::uint64_t seed = 0) {
  return hash_bytes(text.data(), text.size(), seed);
}

TEST(Hash, IsTheSameInEveryVersion) {
  EXPECT_EQ(hash_of(""), 0xb5fe1d196a51a00bU);
  EXPECT_EQ(hash_of("muslin"), 0xad454ff24a08e6f3U);
  EXPECT_EQ(hash_of("a muslin is a trial garment", 7), 0x1eb3356cbcab8319U);
}

TEST(Hash, DependsOnEveryByteAndOnTheSeed) {
  EXPECT_NE(hash_of("muslin"), hash_of("muslim"));
  EXPECT_NE(hash_of("a muslin is a trial garment"), hash_of("a muslin is a Trial garment"));
  EXPECT_NE(hash_of("muslin", 1), hash_of("muslin", 2));
  EXPECT_NE(hash_of({"\0", 1}), hash_of(""));
}

}  // namespace
}  // namespace muslin
