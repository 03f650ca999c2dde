#include "io/fixtures.hpp"

#include <bit>
#include <cstdint>
#include <cstring>

#include <assimp/Exporter.hpp>
#include <assimp/scene.h>
#include <gtest/gtest.h>

namespace muslin::fixtures {
namespace {

template <class Number>
void put(std::string& bytes, Number value, bool big_endian = false) {
  std::string raw(sizeof value, '\0');
  std::memcpy(raw.data(), &value, sizeof value);
  if (big_endian) raw.assign(raw.rbegin(), raw.rend());
  bytes += raw;
}

std::string base64(const std::string& bytes) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : letters[word >> (18 - 6 * k) & 63];
  }
  return text;
}

std::string gltf_buffer() {
  std::string bytes;
  for (const float x :
       {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 0.f})
    put(bytes, x);
  for (const float x : {0.f, 0.f, 1.f, 0.f, 1.f, 1.f, .5f, 0.f, .5f, 1.f, 0.f, 1.f}) put(bytes, x);
  for (std::uint16_t i = 0; i < 6; ++i) put(bytes, i);
  return bytes;
}

std::string gltf_text(const std::string& uri) {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"name":"first","mesh":0,"children":[1]},{"name":"second node","mesh":0,"translation":[0,0,5],"scale":[-1,1,1]}],
"meshes":[{"name":"square","primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1,"COLOR_0":0,"_PAINT":2,"_WIND":1},"indices":2}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":6,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
{"bufferView":1,"componentType":5126,"count":6,"type":"VEC2"},
{"bufferView":2,"componentType":5123,"count":6,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":72},{"buffer":0,"byteOffset":72,"byteLength":48},
{"buffer":0,"byteOffset":120,"byteLength":12}],
"buffers":[{)" +
         uri + R"("byteLength":132}]})";
}

std::string exported(const char* format) {
  auto scene = std::make_unique<aiScene>();
  scene->mRootNode = new aiNode("rectangle");
  scene->mNumMaterials = 1;
  scene->mMaterials = new aiMaterial*[1]{new aiMaterial};
  scene->mNumMeshes = 1;
  scene->mMeshes = new aiMesh*[1]{new aiMesh};
  aiMesh& mesh = *scene->mMeshes[0];
  mesh.mPrimitiveTypes = aiPrimitiveType_POLYGON;
  mesh.mNumVertices = 4;
  mesh.mVertices = new aiVector3D[4]{{0, 0, 0}, {100, 0, 0}, {100, 200, 0}, {0, 200, 0}};
  mesh.mNumFaces = 1;
  mesh.mFaces = new aiFace[1];
  mesh.mFaces[0].mNumIndices = 4;
  mesh.mFaces[0].mIndices = new unsigned[4]{0, 1, 2, 3};
  scene->mRootNode->mNumMeshes = 1;
  scene->mRootNode->mMeshes = new unsigned[1]{0};
  Assimp::Exporter exporter;
  const aiExportDataBlob* blob = exporter.ExportToBlob(scene.get(), format);
  return blob == nullptr ? "" : std::string(static_cast<const char*>(blob->data), blob->size);
}

}  // namespace

std::string obj() {
  return "# a banner\nmtllib none.mtl\no banner of cloth\n"
         "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 9 9 9\nvn 0 0 1\n"
         "vt 0 0\nvt 0.5 0\nvt 0.5 1\nvt 0 1\nvt 0.25 0.125\nvt 0.5\n"
         "usemtl red\ns off\ng left\nf 1/1/1 2/2/1 5/3/1 4/4/1\ng right\nf 2/5 3/6 6/1\nf 6//1 5//1 2//1\ng "
         "pins\np 1 4\n";
}

std::string ply_ascii() {
  return "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 5\nproperty float x\nproperty float y\n"
         "property double z\nproperty uchar red\nproperty float s\nproperty float t\nelement face 2\n"
         "property list uchar int vertex_indices\nend_header\n"
         "0 0 0 255 0 0\n1 0 0 255 1 0\n1 1 0 255 1 1\n0 1 0 255 0 1\n2 0.5 0.125 255 2 0.5\n"
         "4 0 1 2 3\n3 1 4 2\n";
}

std::string ply_binary(bool big_endian) {
  std::string bytes = ply_ascii();
  bytes.resize(bytes.find("end_header\n") + 11);
  bytes.replace(bytes.find("ascii"), 5, big_endian ? "binary_big_endian" : "binary_little_endian");
  const float vertices[5][5] = {
      {0, 0, 0, 0, 0}, {1, 0, 0, 1, 0}, {1, 1, 0, 1, 1}, {0, 1, 0, 0, 1}, {2, .5f, .125f, 2, .5f}};
  for (const auto& v : vertices) {
    put(bytes, v[0], big_endian);
    put(bytes, v[1], big_endian);
    put(bytes, static_cast<double>(v[2]), big_endian);
    put(bytes, std::uint8_t{255});
    put(bytes, v[3], big_endian);
    put(bytes, v[4], big_endian);
  }
  put(bytes, std::uint8_t{4});
  for (const std::int32_t i : {0, 1, 2, 3}) put(bytes, i, big_endian);
  put(bytes, std::uint8_t{3});
  for (const std::int32_t i : {1, 4, 2}) put(bytes, i, big_endian);
  return bytes;
}

std::string stl_ascii() {
  return "solid two triangles\n  facet normal 0 0 1\n    outer loop\n      vertex 0 0 0\n      vertex 1 0 0\n"
         "      vertex 1 1 0\n    endloop\n  endfacet\n  facet normal nan nan nan\n    outer loop\n"
         "      vertex -0 0 0\n      vertex 1.0 1 0\n      vertex 0 1e0 0\n    endloop\n  endfacet\nendsolid "
         "two triangles\n";
}

std::string stl_binary() {
  std::string bytes(80, ' ');
  put(bytes, std::uint32_t{2});
  for (const auto& triangle :
       {std::array{0.f, 0.f, 1.f, 0.f, 1.f, 1.f}, std::array{-0.f, 0.f, 1.f, 1.f, 0.f, 1.f}}) {
    bytes += std::string(12, '\0');
    for (std::size_t c = 0; c < 3; ++c) {
      put(bytes, triangle[2 * c]);
      put(bytes, triangle[2 * c + 1]);
      put(bytes, 0.f);
    }
    bytes += std::string(2, '\0');
  }
  return bytes;
}

std::string gltf() {
  return gltf_text("\"uri\":\"data:application/octet-stream;base64," + base64(gltf_buffer()) + "\",");
}

std::string glb() {
  std::string text = gltf_text(""), bytes = "glTF", buffer = gltf_buffer();
  while (text.size() % 4 != 0) text += ' ';
  put(bytes, std::uint32_t{2});
  put(bytes, static_cast<std::uint32_t>(28 + text.size() + buffer.size()));
  put(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += "JSON" + text;
  put(bytes, static_cast<std::uint32_t>(buffer.size()));
  bytes += std::string("BIN\0", 4) + buffer;
  return bytes;
}

std::string collada() {
  return R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="square" name="square"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 100 0 0 100 0 100 0 0 100</float_array><technique_common>
<accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<source id="t"><float_array id="ta" count="8">0 0 1 0 1 1 0 1</float_array><technique_common>
<accessor source="#ta" count="4" stride="2"><param name="S" type="float"/><param name="T" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/><input semantic="TEXCOORD" source="#t" offset="1" set="0"/>
<vcount>4</vcount><p>0 0 1 1 2 2 3 3</p></polylist>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n" name="flag"><instance_geometry url="#square"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
)";
}

std::string fbx() { return exported("fbxa"); }

TEST(Fixtures, AssimpExports) { EXPECT_NE(fbx(), ""); }

}  // namespace muslin::fixtures
