// Material files and the library.
#include "muslin/material/material.hpp"

#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"

namespace muslin {
namespace {

using testing::Contains;
using testing::HasSubstr;

std::string message(const std::string& text) {
  try {
    parse_material(text, "m.toml");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(MaterialLibrary, HoldsTheFlagOfTheThesis) {
  const Material flag = find_material("thesis_flag");
  EXPECT_EQ(flag.density, 10);
  EXPECT_EQ(flag.edge_modulus, 20000);
  EXPECT_EQ(flag.face_diagonal_modulus, 100);
  EXPECT_EQ(flag.body_diagonal_modulus, 100);
}

TEST(MaterialLibrary, HoldsEveryFileOfTheFolderAndEachParses) {
  const std::vector<std::string> names = material_names();
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
  std::size_t files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(MUSLIN_SOURCE_DIR) / "materials")) {
    if (entry.path().extension() != ".toml") continue;
    ++files;
    const std::string name = entry.path().stem().string();
    EXPECT_THAT(names, Contains(name));
    const Material material = find_material(name);
    EXPECT_EQ(material.name, name);
    EXPECT_FALSE(material.description.empty()) << name;
    EXPECT_FALSE(material.source.empty()) << name;
    EXPECT_TRUE(material.shell || material.edge_modulus > 0) << name;
    EXPECT_EQ(read_material(entry.path()).edge_modulus, material.edge_modulus) << name;
  }
  EXPECT_EQ(files, names.size());
}

TEST(MaterialLibrary, UnknownNameIsAnErrorWithTheNearestName) {
  try {
    find_material("thesis_falg");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_STREQ(error.what(),
                 "there is no material `thesis_falg`; did you mean `thesis_flag`? (`muslin materials` lists "
                 "them all)");
  }
}

TEST(MaterialFile, ReadsEveryQuantityAndKeepsReferenceNumbers) {
  const Material m = parse_material(
      "name = 'n'\ndescription = 'd'\nsource = 's'\n[lattice]\ndensity = 1\nedge_modulus = 2\n"
      "face_diagonal_modulus = 3\nbody_diagonal_modulus = 4\nvolume_modulus = 5\nmass_damping = 6\n"
      "stiffness_damping = 7\n[reference]\nyoungs_modulus = 8\nremark = 'measured'\n",
      "m.toml");
  EXPECT_EQ(m.name + m.description + m.source, "nds");
  EXPECT_EQ(m.density, 1);
  EXPECT_EQ(m.edge_modulus, 2);
  EXPECT_EQ(m.face_diagonal_modulus, 3);
  EXPECT_EQ(m.body_diagonal_modulus, 4);
  EXPECT_EQ(m.volume_modulus, 5);
  EXPECT_EQ(m.mass_damping, 6);
  EXPECT_EQ(m.stiffness_damping, 7);
  EXPECT_EQ(m.reference, (std::vector<std::pair<std::string, double>>{{"youngs_modulus", 8}}));
}

TEST(MaterialFile, SaysWhichNumbersAreGuesses) {
  const std::string sheet = "[shell]\nareal_density = 0.2\nwarp_curve = [[0.1, 20]]\nbending_warp = 1e-5\n";
  const Material m = parse_material("guesses = ['shell.warp_curve', 'shell.poisson']\n" + sheet, "m.toml");
  for (const MaterialNumber& number : shell_numbers(m)) EXPECT_EQ(number.guess, number.key == "poisson");
  const std::vector<MaterialCurve> curves = shell_curves(m);
  ASSERT_EQ(curves.size(), 2u);
  EXPECT_EQ(curves[0].key, "warp_curve");
  EXPECT_TRUE(curves[0].guess);
  EXPECT_EQ(curves[1].key, "weft_curve");
  EXPECT_FALSE(curves[1].guess);
  EXPECT_THAT(
      message("guesses = ['shell.poison']\n" + sheet),
      HasSubstr(
          "`shell.poison` in `guesses` is not a number of this material; did you mean `shell.poisson`?"));
  EXPECT_THAT(message("guesses = ['shell.membrane_warp']\n" + sheet),
              HasSubstr("is not a number of this material"));
  EXPECT_THAT(message("guesses = ['lattice.density']\n" + sheet),
              HasSubstr("is not a number of this material"));
}

TEST(MaterialFile, WrongFilesAreErrorsAtTheirPlace) {
  EXPECT_THAT(message("[lattice]\ndensity = 1\nedge_modulus = 1\nedge_modulos = 2\n"),
              HasSubstr("m.toml:4:1: unknown key `edge_modulos` in `lattice` of the material file; did you "
                        "mean `edge_modulus`?"));
  EXPECT_THAT(message("[lattice]\ndensity = 0\nedge_modulus = 1\n"), HasSubstr("m.toml:2:11: `density`"));
  EXPECT_THAT(message("[lattice]\nedge_modulus = 1\n"), HasSubstr("has no `density`"));
  EXPECT_THAT(message("name = 'x'\n"), HasSubstr("no table [lattice] or [shell]"));
  EXPECT_THAT(message("[lattice"), HasSubstr("m.toml:1:"));
}

TEST(MaterialFile, AMissingFileIsAFileError) {
  try {
    read_material("/nowhere/m.toml");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::file);
    EXPECT_STREQ(error.what(), "/nowhere/m.toml: cannot read: No such file or directory; check the path");
  }
}

}  // namespace
}  // namespace muslin
