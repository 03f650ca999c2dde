// Text in HTML and XML.
#include "muslin/core/markup.hpp"

#include <gtest/gtest.h>

namespace muslin {
namespace {

TEST(Markup, IsEscaped) {
  EXPECT_EQ(escaped_markup("a < b && \"c\" > d"), "a &lt; b &amp;&amp; &quot;c&quot; &gt; d");
  EXPECT_EQ(escaped_markup("it's 3 µm"), "it's 3 µm");
}

TEST(Markup, LosesControlCharactersButNotTabsAndLineEnds) {
  EXPECT_EQ(escaped_markup("a\tb\nc"), "a\tb\nc");
  EXPECT_EQ(escaped_markup({"a\0\x1b\rb", 5}), "ab");
}

}  // namespace
}  // namespace muslin
