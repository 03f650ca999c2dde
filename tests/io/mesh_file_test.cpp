#include "muslin/io/mesh_file.hpp"

#include <algorithm>
#include <bit>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <random>

#include "io/fixtures.hpp"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "muslin/core/error.hpp"
#include "muslin/geometry/inspect.hpp"
#include "muslin/io/mesh_writers.hpp"

namespace muslin {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

MeshFile read(const std::string& bytes, const std::string& suffix) {
  return read_mesh_from(bytes, suffix, "mesh" + suffix);
}

Error refused(const std::string& bytes, const std::string& suffix) {
  try {
    read(bytes, suffix);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::input);
    EXPECT_EQ(error.place().file, "mesh" + suffix);
    EXPECT_FALSE(error.remedy().empty());
    return error;
  }
  ADD_FAILURE() << "accepted: " << bytes.substr(0, 200);
  return Error(ErrorKind::input, "accepted", "");
}

void expect_same(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.face_offsets, b.face_offsets);
  EXPECT_EQ(a.face_vertices, b.face_vertices);
  EXPECT_EQ(a.uvs, b.uvs);
  EXPECT_EQ(a.corner_uvs, b.corner_uvs);
  ASSERT_EQ(a.groups.size(), b.groups.size());
  for (std::size_t g = 0; g < a.groups.size(); ++g) {
    EXPECT_EQ(a.groups[g].name, b.groups[g].name);
    EXPECT_EQ(a.groups[g].faces, b.groups[g].faces);
    EXPECT_EQ(a.groups[g].vertices, b.groups[g].vertices);
  }
  ASSERT_EQ(a.materials.size(), b.materials.size());
  for (std::size_t m = 0; m < a.materials.size(); ++m) {
    EXPECT_EQ(a.materials[m].name, b.materials[m].name);
    EXPECT_EQ(a.materials[m].faces, b.materials[m].faces);
  }
}

class Folder : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              ("muslin_io_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path folder_;
};

TEST(ObjReader, KeepsOrderPolygonsSeamsAndGroups) {
  const Mesh mesh = read(fixtures::obj(), ".obj").mesh;
  EXPECT_EQ(mesh.name, "banner of cloth");
  ASSERT_EQ(mesh.positions.size(), 7u);
  EXPECT_EQ(mesh.positions[1], Vec3(1, 0, 0));
  EXPECT_EQ(mesh.positions[6], Vec3(9, 9, 9));
  EXPECT_THAT(mesh.face_offsets, ElementsAre(0, 4, 7, 10));
  EXPECT_THAT(mesh.face_vertices, ElementsAre(0, 1, 4, 3, 1, 2, 5, 5, 4, 1));
  EXPECT_THAT(mesh.corner_uvs, ElementsAre(0, 1, 2, 3, 4, 5, 0, -1, -1, -1));
  EXPECT_EQ(mesh.uvs[5], Vec2(0.5, 0));
  ASSERT_EQ(mesh.groups.size(), 3u);
  EXPECT_EQ(mesh.groups[0].name, "left");
  EXPECT_THAT(mesh.groups[0].faces, ElementsAre(0));
  EXPECT_THAT(mesh.groups[0].vertices, ElementsAre(0, 1, 3, 4));
  EXPECT_EQ(mesh.groups[1].name, "right");
  EXPECT_THAT(mesh.groups[1].faces, ElementsAre(1, 2));
  EXPECT_EQ(mesh.groups[2].name, "pins");
  EXPECT_THAT(mesh.groups[2].faces, IsEmpty());
  EXPECT_THAT(mesh.groups[2].vertices, ElementsAre(0, 3));
}

TEST(ObjReader, TakesEveryLineEndAndNegativeIndices) {
  const std::string plain = "v 0 0 0\nv 1 0 0 1.0\nv 0 1 0 .5 .5 .5\nv 1 +1 0e-400\nf 1 2 4 3\n";
  const Mesh mesh = read(plain, ".obj").mesh;
  EXPECT_EQ(mesh.positions[3], Vec3(1, 1, 0));
  for (const std::string end : {"\r\n", "\r", "\n\n", " \t\n"}) {
    std::string text;
    for (const char c : plain) c == '\n' ? text += end : text += c;
    expect_same(read(text, ".obj").mesh, mesh);
  }
  expect_same(read("\xEF\xBB\xBF"
                   "f 1 2 \\\r\n 4\\\n 3\nv 0 0 0\nv 1 0\\\n 0\nv 0 1 0\nv 1 1 0",
                   ".obj")
                  .mesh,
              mesh);
  expect_same(read("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf -4//1 -3/ -1 3 # -2\n# a path\\\n", ".obj").mesh,
              mesh);
}

TEST(ObjReader, SeveralObjectsBecomeGroups) {
  const std::string text =
      "o front side\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no back\ng trim\nv 0 0 1\nf 1 2 4\nl 1 2\nzzz 1\n";
  const MeshFile file = read(text, ".obj");
  EXPECT_EQ(file.mesh.name, "");
  ASSERT_EQ(file.mesh.groups.size(), 3u);
  EXPECT_EQ(file.mesh.groups[0].name, "front_side");
  EXPECT_EQ(file.mesh.groups[1].name, "back");
  EXPECT_EQ(file.mesh.groups[2].name, "trim");
  EXPECT_THAT(file.note, HasSubstr("1 lines"));
  EXPECT_THAT(file.note, HasSubstr("line 11"));
  expect_same(read(to_obj(file.mesh, file.mesh.positions), ".obj").mesh, file.mesh);
}

TEST(ObjReader, KeepsTheFacesOfMaterials) {
  const MeshFile file = read(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nusemtl Blue Cotton\ng rib\nf 1 3 2\nusemtl none\nusemtl rib\nf 2 "
      "3 1\n"
      "usemtl Blue Cotton\nf 3 1 2\n",
      ".obj");
  const std::vector<MeshMaterial>& materials = file.mesh.materials;
  ASSERT_EQ(materials.size(), 2u) << "a material without faces is left out";
  EXPECT_EQ(materials[0].name, "Blue Cotton");
  EXPECT_THAT(materials[0].faces, ElementsAre(1, 3));
  EXPECT_EQ(materials[1].name, "rib");
  EXPECT_THAT(materials[1].faces, ElementsAre(2));
  EXPECT_THAT(file.mesh.material_of_face(), ElementsAre(-1, 0, 1, 0));
  expect_same(read(to_obj(file.mesh, file.mesh.positions), ".obj").mesh, file.mesh);
  ASSERT_EQ(file.mesh.groups.size(), 1u) << "materials are no groups";
  EXPECT_THAT(file.mesh.groups[0].faces, ElementsAre(1, 2, 3));
}

TEST(ObjReader, NamesTheLineOfEveryFault) {
  const std::string good = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  const std::vector<std::tuple<std::string, int, const char*>> faults = {
      {"f 1 2 3\nf 1 2 9\nf 1 2 3\n", 5, "vertex 9, but there are 3"},
      {"f 1 2 -4\n", 4, "only 3 before it"},
      {"f 1 2 0\n", 4, "counting starts at 1"},
      {"vt 0 0\nf 1/1 2/2 3/1\n", 5, "texture coordinate 2"},
      {"f 1 2\n", 4, "2 corners"},
      {"f 1 2 x\n", 4, "'x' is not a whole number"},
      {"f 1 2 99999999999999999999\n", 4, "whole number"},
      {"f 1 2 4000000000\n", 4, "4000000000"},
      {"v nan 0 0\nf 1 2 3\n", 4, "not a finite number"},
      {"v 0 -inf 0\nf 1 2 3\n", 4, "not a finite number"},
      {"v 0 0 1e30\nf 1 2 3\n", 4, "1e9 m"},
      {"v 0 0 1e999\nf 1 2 3\n", 4, "finite"},
      {"v 0 0 -1.#IND\nf 1 2 3\n", 4, "not a number"},
      {"v 0 0,5 0\nf 1 2 3\n", 4, "not a number"},
      {"v 0 0\nf 1 2 3\n", 4, "missing"},
      {"\n# note\nvt nan\nf 1 2 3\n", 6, "finite"},
  };
  for (const auto& [text, line, problem] : faults) {
    const Error error = refused(good + text, ".obj");
    EXPECT_EQ(error.place().line, line) << error.what();
    EXPECT_THAT(error.problem(), HasSubstr(problem));
  }
  EXPECT_EQ(refused(good + "f 1 2 x\n", ".obj").place().column, 7);
}

TEST(MeshFile, RefusesFilesThatAreNotMeshes) {
  EXPECT_THAT(refused("", ".obj").what(), HasSubstr("empty"));
  EXPECT_THAT(refused(" \n\n", ".stl").what(), HasSubstr("empty"));
  EXPECT_THAT(refused("\x89PNG\r\n\x1a\n", ".obj").what(), HasSubstr("PNG"));
  EXPECT_THAT(refused("Dear reader,\nthis is prose.\n", ".obj").what(), HasSubstr("mesh.obj:1:1"));
  EXPECT_THAT(refused("# Notes\n\nfor all\n", ".obj").what(), HasSubstr("mesh.obj:3:1"));
  EXPECT_THAT(refused("v 0 0 0\nv 1 0 0\n", ".obj").what(), HasSubstr("no faces"));
  EXPECT_THAT(refused("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", ".obj").what(), HasSubstr("no area"));
  EXPECT_THAT(refused(fixtures::glb(), ".obj").what(), HasSubstr(".glb"));
  EXPECT_THAT(refused("ply\nformat ascii 1.0\n", ".stl").what(), HasSubstr(".ply"));
  EXPECT_THAT(refused("Dear reader", ".max").what(), HasSubstr(".max"));
  for (const char* suffix : {".ply", ".stl", ".gltf", ".glb", ".dae", ".fbx"}) {
    refused("Dear reader,\nthis is prose, and not short: " + std::string(500, '.'), suffix);
    refused(fixtures::obj(), suffix);
  }
}

TEST_F(Folder, MissingFilesAndFoldersAreFileErrors) {
  const auto kind = [](const fs::path& path) {
    try {
      read_mesh(path);
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(path.string()));
      return error.kind();
    }
    return ErrorKind::input;
  };
  EXPECT_EQ(kind(folder_ / "none.obj"), ErrorKind::file);
  EXPECT_EQ(kind(folder_), ErrorKind::file);
  fs::create_directory(folder_ / "folder.obj");
  EXPECT_EQ(kind(folder_ / "folder.obj"), ErrorKind::file);
  EXPECT_EQ(kind("/dev/zero"), ErrorKind::file);
}

TEST(Ply, ReadsEveryFormatAlike) {
  for (const bool big : {false, true}) {
    const Mesh binary = read(fixtures::ply_binary(big), ".ply").mesh;
    const Mesh ascii = read(fixtures::ply_ascii(), ".ply").mesh;
    expect_same(binary, ascii);
    EXPECT_THAT(ascii.face_offsets, ElementsAre(0, 4, 7));
    EXPECT_THAT(ascii.face_vertices, ElementsAre(0, 1, 2, 3, 1, 4, 2));
    EXPECT_EQ(ascii.corner_uvs, ascii.face_vertices);
    EXPECT_EQ(ascii.uvs[4], Vec2(2, 0.5));
  }
}

TEST(Ply, NamesTheLineOrTheFace) {
  std::string text = fixtures::ply_ascii();
  text.replace(text.find("3 1 4 2"), 7, "3 1 5 2");
  EXPECT_THAT(refused(text, ".ply").problem(), HasSubstr("face 2 uses vertex 5"));
  text = fixtures::ply_ascii();
  text.replace(text.find("4 0 1 2 3"), 9, "2 0 1    ");
  EXPECT_EQ(refused(text, ".ply").place().line, 19);
  text = fixtures::ply_ascii();
  text.replace(text.find("2 0.5 0"), 7, "2 1e30 0");
  EXPECT_EQ(refused(text, ".ply").place().line, 18);
}

TEST(Ply, ChecksEveryCount) {
  for (const char* format : {"ascii", "binary_little_endian"}) {
    const std::string head = "ply\nformat " + std::string(format) + " 1.0\n";
    refused(
        head +
            "element vertex 2147483646\nproperty float x\nproperty float y\nproperty float z\nend_header\n",
        ".ply");
    refused(head + "element vertex 99999999999999\nproperty float x\nend_header\n", ".ply");
    refused(head + "element nothing 2147483646\nend_header\n", ".ply");
    refused(head + "element face 1\nproperty list uint int vertex_indices\nend_header\n\xff\xff\xff\xff",
            ".ply");
  }
}

TEST(Ply, ReadsStripsOfTriangles) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n1 1 0\n2 0 0\n2 1 0\n"
      "9 0 1 2 3 -1 1 4 3 5\n";
  const Mesh mesh = read(text, ".ply").mesh;
  EXPECT_THAT(mesh.face_offsets, ElementsAre(0, 3, 6, 9, 12));
  EXPECT_THAT(mesh.face_vertices, ElementsAre(0, 1, 2, 2, 1, 3, 1, 4, 3, 3, 4, 5));
}

TEST(Stl, ReadsTheDialectsOfPrograms) {
  const std::string plain = fixtures::stl_ascii();
  const Mesh wanted = read(plain, ".stl").mesh;
  const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != text.npos; at = text.find(from, at + to.size()))
      text.replace(at, from.size(), to);
    return text;
  };
  std::string capitals = plain;
  std::transform(capitals.begin(), capitals.end(), capitals.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  std::string split = plain;
  for (const char* word : {"solid", "loop", "facet"})
    split = replaced(split, "end" + std::string(word), "end " + std::string(word));
  std::string unity = plain;
  unity.replace(0, plain.find('\n'), "Solid Unity Mesh");
  const std::string windows = replaced(plain, "\n", "\r\n");
  for (const std::string& text : {capitals, split, unity, windows})
    EXPECT_EQ(read(text, ".stl").mesh.positions, wanted.positions) << text;
}

TEST(Stl, WeldsByExactPosition) {
  for (const std::string& bytes : {fixtures::stl_ascii(), fixtures::stl_binary()}) {
    const MeshFile file = read(bytes, ".stl");
    EXPECT_EQ(file.mesh.positions.size(), 4u);
    EXPECT_THAT(file.mesh.face_vertices, ElementsAre(0, 1, 2, 0, 2, 3));
    EXPECT_THAT(file.note, HasSubstr("6 corners were welded by position into 4 vertices"));
  }
  EXPECT_EQ(read(fixtures::stl_ascii(), ".stl").mesh.name, "two triangles");
}

TEST(Stl, BinaryMayBeginWithSolidAndMustBeWhole) {
  std::string bytes = fixtures::stl_binary();
  bytes.replace(0, 5, "solid");
  EXPECT_EQ(read(bytes, ".stl").mesh.face_count(), 2u);
  bytes = fixtures::stl_binary();
  EXPECT_THAT(refused(bytes.substr(0, bytes.size() - 1), ".stl").what(), HasSubstr("2 triangles"));
  std::memcpy(bytes.data() + 80, "\xff\xff\xff\xff", 4);
  refused(bytes, ".stl");
  EXPECT_EQ(
      refused("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 nan\n", ".stl").place().line,
      5);
}

/// Returns the glTF fixture with one text in place of another.
std::string altered_gltf(const std::string& from, const std::string& to) {
  std::string text = fixtures::gltf();
  EXPECT_NE(text.find(from), text.npos) << from;
  return text.replace(text.find(from), from.size(), to);
}

TEST(Gltf, ReadsNodesTransformsAndSeams) {
  for (const auto& [bytes, suffix] :
       {std::pair{fixtures::glb(), ".glb"}, std::pair{fixtures::gltf(), ".gltf"}}) {
    const MeshFile file = read(bytes, suffix);
    const Mesh& mesh = file.mesh;
    // One square of two triangles that share an edge with different texture coordinates, placed twice: as it
    // is, and mirrored in x with a translation.
    ASSERT_EQ(mesh.positions.size(), 8u) << suffix;
    ASSERT_EQ(mesh.face_count(), 4u);
    EXPECT_EQ(mesh.uvs.size(), 12u);
    EXPECT_EQ(mesh.uvs[1], Vec2(1, 1));
    ASSERT_EQ(mesh.groups.size(), 2u);
    EXPECT_EQ(mesh.groups[0].name, "first");
    EXPECT_EQ(mesh.groups[1].name, "second_node");
    EXPECT_THAT(mesh.groups[1].faces, ElementsAre(2, 3));
    EXPECT_EQ(mesh.bounds().min(), Vec3(-1, 0, 0));
    EXPECT_EQ(mesh.bounds().max(), Vec3(1, 1, 5));
    for (std::size_t f = 0; f < 4; ++f) EXPECT_GT(newell_normal(mesh.positions, mesh.face(f)).z(), 0) << f;
    EXPECT_THAT(file.note, HasSubstr("12 stored vertices were welded by position into 8"));
  }
}

TEST(Gltf, ReadsAttributesAndColours) {
  for (const auto& [bytes, suffix] :
       {std::pair{fixtures::glb(), ".glb"}, std::pair{fixtures::gltf(), ".gltf"}}) {
    const std::vector<VertexAttribute> attributes = read(bytes, suffix).attributes;
    std::vector<std::string> names;
    for (const VertexAttribute& attribute : attributes) names.push_back(attribute.name);
    ASSERT_THAT(names, ElementsAre("red", "green", "blue", "_PAINT", "_WIND.x", "_WIND.y")) << suffix;
    // Of each square the vertices at two corners are stored twice, the first as 0 and 3, the third as 2
    // and 4.
    EXPECT_THAT(attributes[0].values, ElementsAre(0, 1, 1, 0, 0, 1, 1, 0));
    EXPECT_THAT(attributes[3].values, ElementsAre(1.5, 1, 3, 5, 1.5, 1, 3, 5));
  }
}

TEST(Gltf, HasNoValueWhereAPartLacksTheAttribute) {
  std::string text = altered_gltf(R"("second node","mesh":0)", R"("second node","mesh":1)");
  text.replace(text.find(R"(}]}],)"), 5,
               R"(}]},{"primitives":[{"attributes":{"POSITION":0},"indices":2}]}],)");
  const std::vector<VertexAttribute> attributes = read(text, ".gltf").attributes;
  ASSERT_EQ(attributes.size(), 6u);
  for (const VertexAttribute& attribute : attributes) {
    ASSERT_EQ(attribute.values.size(), 8u);
    for (std::size_t v = 0; v < 8; ++v) EXPECT_EQ(std::isnan(attribute.values[v]), v >= 4) << v;
  }
}

TEST(Gltf, LeavesOutAttributesWithoutDataOrOfMatrices) {
  for (const char* accessor : {R"("componentType":5126,"count":6,"type":"SCALAR")",
                               R"("bufferView":0,"componentType":5126,"count":1,"type":"MAT2")"}) {
    std::string text = altered_gltf(R"("_PAINT":2)", R"("_PAINT":3)");
    text.replace(text.find("],\n\"bufferViews"), 1, std::string(",{") + accessor + "}]");
    const std::vector<VertexAttribute> attributes = read(text, ".gltf").attributes;
    EXPECT_EQ(attributes.size(), 5u) << accessor;
  }
}

TEST(Gltf, ChecksTheContentOfTheFile) {
  refused(altered_gltf("\"count\":6,\"type\":\"VEC3\"", "\"count\":600000000,\"type\":\"VEC3\""), ".gltf");
  refused(altered_gltf("\"byteOffset\":72", "\"byteOffset\":1000"), ".gltf");
  refused(altered_gltf("\"children\":[1]", "\"children\":[0]"), ".gltf");
  refused(altered_gltf("\"children\":[1]", "\"children\":[7]"), ".gltf");
  refused(altered_gltf("\"POSITION\":0", "\"POSITION\":9"), ".gltf");
  refused(altered_gltf("data:application/octet-stream;base64,", "elsewhere.bin?"), ".gltf");
  refused(altered_gltf("\"translation\":[0,0,5]", "\"translation\":[0,0,1e300]"), ".gltf");
  refused(altered_gltf("\"_PAINT\":2", "\"_PAINT\":9"), ".gltf");
  std::string text = altered_gltf("\"_PAINT\":2", "\"_PAINT\":3");
  text.replace(text.find("],\n\"bufferViews"), 1,
               ",{\"bufferView\":2,\"componentType\":5123,\"count\":5,\"type\":\"SCALAR\"}]");
  EXPECT_THAT(refused(text, ".gltf").what(), HasSubstr("the attribute _PAINT has 5 values for 6 positions"));
}

TEST(Collada, AppliesUnitAndAxis) {
  const MeshFile file = read(fixtures::collada(), ".dae");
  EXPECT_EQ(file.mesh.positions.size(), 4u);
  ASSERT_EQ(file.mesh.face_count(), 1u);
  EXPECT_EQ(file.mesh.face(0).size(), 4u);
  // A square of 100 in x and z, z up, in centimetres: stands 1 m high in y up.
  EXPECT_LT((file.mesh.bounds().sizes() - Vec3(1, 1, 0)).norm(), 1e-6)
      << file.mesh.bounds().sizes().transpose();
  EXPECT_EQ(file.mesh.corner_uvs.size(), 4u);
  EXPECT_THAT(file.note, HasSubstr("float"));
}

TEST(Fbx, ReadsFilesWrittenByAssimp) {
  const MeshFile file = read(fixtures::fbx(), ".fbx");
  EXPECT_EQ(file.mesh.positions.size(), 4u);
  EXPECT_EQ(file.mesh.face_count(), 1u);
  EXPECT_LT((file.mesh.bounds().sizes() - Vec3(1, 2, 0)).norm(), 1e-6)
      << file.mesh.bounds().sizes().transpose() << file.note;
  EXPECT_THAT(file.note, HasSubstr("metres"));
}

TEST_F(Folder, ObjRoundTripIsExact) {
  Mesh mesh = read(fixtures::obj(), ".obj").mesh;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  for (Vec3& position : mesh.positions)
    for (double& x : position) x = std::ldexp(any(random), static_cast<int>(random() % 60) - 40);
  write_mesh(folder_ / "out.obj", mesh);
  expect_same(read_mesh(folder_ / "out.obj").mesh, mesh);
  write_mesh(folder_ / "again.OBJ", read_mesh(folder_ / "out.obj").mesh);
  expect_same(read_mesh(folder_ / "again.OBJ").mesh, mesh);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 2);  // no temporary file is left
}

TEST_F(Folder, OtherPositionsKeepEverythingElse) {
  const Mesh mesh = read(fixtures::obj(), ".obj").mesh;
  Mesh moved = mesh;
  for (Vec3& position : moved.positions) position += Vec3(0.1, 0.2, 0.3);
  write_mesh(folder_ / "moved.obj", mesh, moved.positions);
  expect_same(read_mesh(folder_ / "moved.obj").mesh, moved);
  write_mesh(folder_ / "moved.ply", mesh, moved.positions);
  EXPECT_EQ(read_mesh(folder_ / "moved.ply").mesh.positions, moved.positions);
  EXPECT_EQ(read_mesh(folder_ / "moved.ply").mesh.face_vertices, moved.face_vertices);
  EXPECT_THROW(write_mesh(folder_ / "x.obj", mesh, ConstVectors(moved.positions).first(2)), Error);
}

TEST_F(Folder, PlyKeepsPolygonsOfManyCorners) {
  Mesh mesh;
  std::vector<int> face;
  for (int c = 0; c < 300; ++c) {
    mesh.positions.push_back(Vec3(std::cos(c * 0.02), std::sin(c * 0.02), 1.0 / 3));
    face.push_back(c);
  }
  mesh.add_face(face);
  write_mesh(folder_ / "disc.ply", mesh);
  expect_same(read_mesh(folder_ / "disc.ply").mesh, mesh);
}

TEST_F(Folder, FailedWritesLeaveTheOldFile) {
  const Mesh mesh = read(fixtures::obj(), ".obj").mesh;
  const auto kind = [&](const fs::path& path) {
    try {
      write_mesh(path, mesh);
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::input;
  };
  EXPECT_EQ(kind(folder_ / "none" / "out.obj"), ErrorKind::file);
  EXPECT_EQ(kind(folder_ / "out.stl"), ErrorKind::file);
  fs::create_directory(folder_ / "folder.obj");
  EXPECT_EQ(kind(folder_ / "folder.obj"), ErrorKind::file);
}

TEST(WriteMesh, ANameThatEndsWithABackslashDoesNotSwallowTheNextLine) {
  Mesh mesh;
  mesh.name = "cloth\\";
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.add_face(std::vector<int>{0, 1, 2});
  mesh.groups.push_back({"hem\\", {0}, {0, 1, 2}});
  const Mesh again = read_mesh_from(to_obj(mesh, mesh.positions), ".obj", "again").mesh;
  EXPECT_EQ(again.positions, mesh.positions);
  EXPECT_EQ(again.face_vertices, mesh.face_vertices);
}

}  // namespace
}  // namespace muslin
