#include "muslin/core/error.hpp"

#include <gtest/gtest.h>

#include "muslin/core/progress.hpp"

namespace muslin {
namespace {

TEST(Error, NamesPlaceProblemAndRemedy) {
  EXPECT_STREQ(Error(ErrorKind::input, {"flag.toml", 3, 7}, "width is 0", "give a width in metres").what(),
               "flag.toml:3:7: width is 0; give a width in metres");
  EXPECT_STREQ(Error(ErrorKind::file, {"flag.obj"}, "no such file", "").what(), "flag.obj: no such file");
  EXPECT_STREQ(Error(ErrorKind::usage, "nothing to do", "name a scene").what(),
               "nothing to do; name a scene");
}

TEST(Progress, ReportsThenStopsWhenCancelled) {
  double seen = -1;
  bool stop = false;
  const Progress progress{[&](double fraction, std::string_view) { seen = fraction; }, [&] { return stop; }};
  progress.at(0.25, "field");
  EXPECT_EQ(seen, 0.25);
  stop = true;
  try {
    progress.at(0.5, "field");
    FAIL() << "not stopped";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::interrupted);
    EXPECT_EQ(seen, 0.5);
  }
}

}  // namespace
}  // namespace muslin
