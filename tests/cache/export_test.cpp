// Every export is parsed back by a reader that shares no code with the writer.
#include "muslin/cache/export.hpp"

#include <cmath>
#include <cstring>
#include <map>

#include "cache/scratch.hpp"
#include "support/small_model.hpp"
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
// As the library was compiled: without pictures and files, which the test hands over itself.
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_FS
#include <tiny_gltf.h>

#include "muslin/cache/run_writer.hpp"
#include "muslin/core/error.hpp"
#include "muslin/io/mesh_file.hpp"
#include "muslin/io/vtk_file.hpp"

namespace muslin {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::Scratch;
using testing::HasSubstr;

constexpr int frames = 4;  // 0 … 3

class Export : public testing::Test {
 protected:
  Export() {
    test::SmallModelOptions options;
    options.tolerance = 1e-4;
    Simulation simulation(std::make_shared<const Model>(test::small_model(options)));
    RunWriter writer(scratch / "run", simulation, frames - 1, false);
    while (simulation.frame() < frames - 1) {
      simulation.advance();
      writer.write_frame();
    }
    writer.finish(RunStatus::finished);
    run = std::make_unique<RunReader>(scratch / "run");
  }
  Scratch scratch;
  std::unique_ptr<RunReader> run;
};

template <class Number>
Number number_at(const std::string& bytes, std::size_t offset) {
  Number value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

TEST_F(Export, Pc2IsTheRunsOwnCache) {
  export_run(*run, scratch / "a.pc2");
  EXPECT_EQ(bytes_of(scratch / "a.pc2"), bytes_of(scratch / "run/flag.skin.pc2"));
}

TEST_F(Export, MddHoldsTheSamePointsBigEndian) {
  export_run(*run, scratch / "a.mdd");
  std::string bytes = bytes_of(scratch / "a.mdd");
  ASSERT_EQ(bytes.size(), 8u + 4 * frames + 12 * 8 * frames);
  for (std::size_t i = 0; i + 4 <= bytes.size(); i += 4)
    std::reverse(bytes.begin() + static_cast<long>(i), bytes.begin() + static_cast<long>(i) + 4);
  EXPECT_EQ(number_at<int>(bytes, 0), frames);
  EXPECT_EQ(number_at<int>(bytes, 4), 8);
  EXPECT_EQ(number_at<float>(bytes, 12), static_cast<float>(1 / 24.0));
  EXPECT_EQ(number_at<float>(bytes, bytes.size() - 4), run->points(0, SurfaceKind::skin, frames - 1)[7].z());
}

TEST_F(Export, ObjSequenceKeepsPolygonsSeamsAndGroups) {
  export_run(*run, scratch / "a.obj");
  EXPECT_FALSE(fs::exists(scratch / "a.0004.obj"));
  const Mesh mesh = read_mesh(scratch / "a.0003.obj").mesh;
  const Mesh& expected = run->mesh(0, SurfaceKind::skin);
  EXPECT_EQ(mesh.face_vertices, expected.face_vertices);
  EXPECT_EQ(mesh.face_offsets, expected.face_offsets);
  ASSERT_EQ(mesh.corner_uvs.size(), 24u);
  EXPECT_EQ(mesh.uvs[static_cast<std::size_t>(mesh.corner_uvs[1])], Vec2(0.5, 0.25));
  const auto points = run->points(0, SurfaceKind::skin, 3);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(mesh.positions[i].cast<float>(), points[i]);
}

TEST_F(Export, PlySequenceOfTheContour) {
  export_run(*run, scratch / "a.ply", {"flag", SurfaceKind::contour});
  const Mesh mesh = read_mesh(scratch / "a.0002.ply").mesh;
  EXPECT_EQ(mesh.face_count(), 12u);
  EXPECT_LT((mesh.positions[0].cast<float>() - run->points(0, SurfaceKind::contour, 2)[0]).norm(), 1e-6);
}

void check_gltf(const tinygltf::Model& model, const RunReader& run) {
  ASSERT_EQ(model.meshes.size(), 1u);
  const auto& primitive = model.meshes[0].primitives[0];
  ASSERT_EQ(primitive.targets.size(), static_cast<std::size_t>(frames) - 1);
  const auto floats = [&](int index) {
    const auto& accessor = model.accessors[static_cast<std::size_t>(index)];
    const auto& view = model.bufferViews[static_cast<std::size_t>(accessor.bufferView)];
    EXPECT_EQ((accessor.byteOffset + view.byteOffset) % 4, 0u);
    const std::size_t width =
        static_cast<std::size_t>(tinygltf::GetNumComponentsInType(static_cast<unsigned>(accessor.type)));
    EXPECT_LE(accessor.byteOffset + accessor.count * width * 4, view.byteLength);
    std::vector<float> values(accessor.count * width);
    std::memcpy(values.data(), model.buffers[0].data.data() + view.byteOffset + accessor.byteOffset,
                4 * values.size());
    for (std::size_t c = 0; c < accessor.minValues.size(); ++c) {
      float low = INFINITY, high = -INFINITY;
      for (std::size_t i = c; i < values.size(); i += width) {
        low = std::min(low, values[i]);
        high = std::max(high, values[i]);
      }
      EXPECT_EQ(static_cast<float>(accessor.minValues[c]), low);
      EXPECT_EQ(static_cast<float>(accessor.maxValues[c]), high);
    }
    return values;
  };
  const auto base = floats(primitive.attributes.at("POSITION"));
  const auto last = floats(primitive.targets.back().at("POSITION"));
  const auto uvs = floats(primitive.attributes.at("TEXCOORD_0"));
  EXPECT_EQ(base.size(), last.size());
  EXPECT_EQ(uvs.size() / 2, base.size() / 3);
  EXPECT_FALSE(
      model.accessors[static_cast<std::size_t>(primitive.attributes.at("POSITION"))].minValues.empty());
  // The set of moved points is that of the run's last frame, to float's last bit.
  const auto points = run.points(0, SurfaceKind::skin, frames - 1);
  std::vector<bool> met(points.size(), false);
  for (std::size_t i = 0; i < base.size(); i += 3) {
    const Vec3f moved(base[i] + last[i], base[i + 1] + last[i + 1], base[i + 2] + last[i + 2]);
    double nearest = INFINITY;
    std::size_t which = 0;
    for (std::size_t p = 0; p < points.size(); ++p) {
      if ((points[p] - moved).norm() >= nearest) continue;
      nearest = (points[p] - moved).norm();
      which = p;
    }
    EXPECT_LT(nearest, 1e-6);
    met[which] = true;
  }
  EXPECT_THAT(met, testing::Each(true));
  EXPECT_EQ(model.accessors[static_cast<std::size_t>(primitive.indices)].count, 36u);
  ASSERT_EQ(model.animations.size(), 1u);
  const auto& sampler = model.animations[0].samplers[0];
  const auto times = floats(sampler.input), weights = floats(sampler.output);
  ASSERT_EQ(times.size(), static_cast<std::size_t>(frames));
  EXPECT_EQ(times[1], static_cast<float>(1 / 24.0));
  EXPECT_EQ(weights, (std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}));
  EXPECT_EQ(model.animations[0].channels[0].target_path, "weights");
  EXPECT_EQ(sampler.interpolation, "LINEAR");
}

TEST_F(Export, GlbIsReadByTinygltf) {
  export_run(*run, scratch / "a.glb");
  const std::string bytes = bytes_of(scratch / "a.glb");
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(number_at<std::uint32_t>(bytes, 8), bytes.size());
  EXPECT_EQ(bytes.size() % 4, 0u);
  EXPECT_EQ(number_at<std::uint32_t>(bytes, 12) % 4, 0u);
  tinygltf::TinyGLTF reader;
  tinygltf::Model model;
  std::string error, warning;
  ASSERT_TRUE(reader.LoadBinaryFromMemory(&model, &error, &warning,
                                          reinterpret_cast<const unsigned char*>(bytes.data()),
                                          static_cast<unsigned>(bytes.size())))
      << error;
  EXPECT_EQ(error + warning, "");
  check_gltf(model, *run);
}

TEST_F(Export, GltfHasItsBufferBesideIt) {
  export_run(*run, scratch / "a.gltf");
  tinygltf::TinyGLTF reader;
  tinygltf::Model model;
  std::string error, warning;
  tinygltf::FsCallbacks files{};
  files.FileExists = [](const std::string& path, void*) { return fs::exists(path); };
  files.ExpandFilePath = [](const std::string& path, void*) { return path; };
  files.ReadWholeFile = [](std::vector<unsigned char>* out, std::string*, const std::string& path, void*) {
    const std::string content = bytes_of(path);
    out->assign(content.begin(), content.end());
    return !content.empty();
  };
  files.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
  };
  reader.SetFsCallbacks(files);
  const std::string text = bytes_of(scratch / "a.gltf");
  ASSERT_TRUE(reader.LoadASCIIFromString(&model, &error, &warning, text.data(),
                                         static_cast<unsigned>(text.size()), scratch.path().string()))
      << error;
  EXPECT_EQ(model.buffers[0].uri, "a.bin");
  check_gltf(model, *run);
}

/// "key = [ … ]" or "frame: [ … ]" behind `from`, its numbers.
std::vector<double> numbers_behind(const std::string& text, const std::string& key, std::size_t from = 0) {
  const std::size_t at = text.find(key, from);
  EXPECT_NE(at, std::string::npos) << key;
  std::vector<double> numbers;
  std::string list = text.substr(text.find('[', at + key.size() - 1) + 1);
  list = list.substr(0, list.find(']'));
  for (char& c : list)
    if (c == '(' || c == ')' || c == ',') c = ' ';
  std::istringstream in(list);
  for (double value; in >> value;) numbers.push_back(value);
  return numbers;
}

TEST_F(Export, MaterialsOfTheMeshAreKept) {
  const fs::path skin = scratch / "run/flag.skin.obj";
  std::string text = bytes_of(skin);
  text.insert(text.find("\nf ") + 1, "usemtl Blue Cotton\n");
  text.insert(text.rfind("\nf ") + 1, "usemtl trim\n");
  std::ofstream(skin) << text;
  const RunReader painted(scratch / "run");

  export_run(painted, scratch / "a.obj");
  const Mesh first = read_mesh(scratch / "a.0000.obj").mesh;
  ASSERT_EQ(first.materials.size(), 2u);
  EXPECT_EQ(first.materials[0].name, "Blue Cotton");
  EXPECT_THAT(first.material_of_face(), testing::ElementsAre(0, 0, 0, 0, 0, 1));

  export_run(painted, scratch / "a.gltf");
  const auto gltf = nlohmann::json::parse(bytes_of(scratch / "a.gltf"));
  const auto& primitives = gltf["meshes"][0]["primitives"];
  ASSERT_EQ(primitives.size(), 2u);
  EXPECT_EQ(gltf["materials"][primitives[0]["material"].get<std::size_t>()]["name"], "Blue Cotton");
  EXPECT_EQ(gltf["accessors"][primitives[0]["indices"].get<std::size_t>()]["count"], 30);
  EXPECT_EQ(gltf["accessors"][primitives[1]["indices"].get<std::size_t>()]["count"], 6);
  EXPECT_EQ(primitives[0]["attributes"], primitives[1]["attributes"]);
  EXPECT_EQ(primitives[0]["targets"], primitives[1]["targets"]);

  export_run(painted, scratch / "a.usda");
  const std::string usd = bytes_of(scratch / "a.usda");
  for (const char* words : {"def Material \"Blue_Cotton\"", "displayName = \"Blue Cotton\"",
                            "familyName = \"materialBind\"", "rel material:binding = </run/materials/trim>"})
    EXPECT_THAT(usd, HasSubstr(words));
}

TEST_F(Export, UsdaHasTimeSamplesUvsAndUnits) {
  export_run(*run, scratch / "a.usda");
  const std::string text = bytes_of(scratch / "a.usda");
  EXPECT_THAT(text, testing::StartsWith("#usda 1.0\n"));
  for (const char* words :
       {"upAxis = \"Y\"", "metersPerUnit = 1", "timeCodesPerSecond = 24", "endTimeCode = 3",
        "defaultPrim = \"run\"", "def Mesh \"flag\"", "interpolation = \"faceVarying\"",
        "def GeomSubset \"front\"", "subdivisionScheme = \"none\""})
    EXPECT_THAT(text, HasSubstr(words));
  EXPECT_EQ(std::count(text.begin(), text.end(), '{'), std::count(text.begin(), text.end(), '}'));
  EXPECT_EQ(numbers_behind(text, "faceVertexCounts = "), std::vector<double>(6, 4.0));
  EXPECT_EQ(numbers_behind(text, "primvars:st:indices = ").size(), 24u);
  const auto flat_points = [&](const std::vector<Vec3f>& points) {
    std::vector<double> numbers;
    for (const Vec3f& p : points) numbers.insert(numbers.end(), p.data(), p.data() + 3);
    return numbers;
  };
  const auto expect_floats = [](const std::vector<double>& actual, const std::vector<double>& expected) {
    ASSERT_EQ(actual.size(), expected.size());
    for (std::size_t i = 0; i < actual.size(); ++i)
      EXPECT_EQ(static_cast<float>(actual[i]), static_cast<float>(expected[i]));
  };
  const std::size_t points = text.find("points.timeSamples"),
                    velocities = text.find("velocities.timeSamples");
  expect_floats(numbers_behind(text, " 2: ", points), flat_points(run->points(0, SurfaceKind::skin, 2)));
  expect_floats(numbers_behind(text, " 2: ", velocities),
                flat_points(run->velocities(0, SurfaceKind::skin, 2)));
  EXPECT_EQ(numbers_behind(text, " 0: ", text.find("extent.timeSamples")),
            (std::vector<double>{0, 0, 0, 3, 2, 1}));
}

TEST_F(Export, VtuSeriesShowsTheLattice) {
  export_run(*run, scratch / "a.vtu");
  EXPECT_THAT(bytes_of(scratch / "a.pvd"), HasSubstr("timestep=\"0.125\" part=\"0\" file=\"a.0003.vtu\""));
  const std::string text = bytes_of(scratch / "a.0003.vtu");
  const std::size_t data = text.find("<AppendedData encoding=\"raw\">\n_") + 31;
  const auto block = [&](const std::string& name) {
    const std::size_t at = text.find("offset=\"", text.find("Name=\"" + name + "\""));
    const std::size_t offset = data + std::stoul(text.substr(at + 8));
    return text.substr(offset + 8, number_at<std::uint64_t>(text, offset));
  };
  EXPECT_EQ(block("Points").size(), 4u * 3 * 4 * 3 * 2);
  EXPECT_EQ(block("types"), std::string(6, '\x0c'));
  const std::string stretch = block("stretch"), displacement = block("displacement");
  ASSERT_EQ(stretch.size(), 6u * 4);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_GT(number_at<float>(stretch, 4 * i), 0.99f);
    EXPECT_LT(number_at<float>(stretch, 4 * i), 1.5f);
  }
  EXPECT_EQ(number_at<float>(displacement, 4), run->selectable_points(0, 3)[0].y());
  EXPECT_EQ(block("velocity").size(), displacement.size());
  // VTK's order of a hexahedron: around the bottom, then around the top.
  const std::string corners = block("connectivity");
  const auto& voxel = run->cells(0).voxels[0];
  EXPECT_EQ(number_at<std::int64_t>(corners, 16), voxel[3]);
  EXPECT_EQ(number_at<std::int64_t>(corners, 24), voxel[2]);
}

TEST_F(Export, FinishesTheSurfaceInEveryFormat) {
  ExportOptions options;
  options.smooth = 1;
  options.subdivide = 1;
  export_run(*run, scratch / "a.obj", options);
  export_run(*run, scratch / "a.usda", options);
  export_run(*run, scratch / "a.glb", options);
  export_run(*run, scratch / "a.pc2", options);
  const Mesh& skin = run->mesh(0, SurfaceKind::skin);
  const Mesh fine = read_mesh(scratch / "a.0003.obj").mesh;
  EXPECT_EQ(fine.face_count(), 4 * skin.face_count());
  ASSERT_EQ(fine.groups.size(), skin.groups.size());
  const std::string text = bytes_of(scratch / "a.usda");
  EXPECT_EQ(numbers_behind(text, "faceVertexCounts = ").size(), fine.face_count());
  const std::vector<double> points = numbers_behind(text, " 3: ", text.find("points.timeSamples"));
  const std::vector<double> before = numbers_behind(text, " 2: ", text.find("points.timeSamples"));
  const std::vector<double> velocities = numbers_behind(text, " 3: ", text.find("velocities.timeSamples"));
  ASSERT_EQ(points.size(), 3 * fine.vertex_count());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(points[i], fine.positions[i / 3][static_cast<int>(i % 3)], 1e-6) << i;
    EXPECT_NEAR(velocities[i], (points[i] - before[i]) * run->frame_rate(), 1e-3) << i;
  }
}

TEST_F(Export, ACarriedMeshTakesThePlaceOfTheSurface) {
  const Mesh& skin = run->mesh(0, SurfaceKind::skin);
  write_mesh(scratch / "fine.obj", skin);
  ExportOptions options;
  options.carry = scratch / "fine.obj";
  const ExportReport report = export_run(*run, scratch / "a.obj", options);
  EXPECT_EQ(report.frames_crossing, 0);
  const Mesh carried = read_mesh(scratch / "a.0003.obj").mesh;
  const auto points = run->points(0, SurfaceKind::skin, 3);
  ASSERT_EQ(carried.vertex_count(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_NEAR((carried.positions[i].cast<float>() - points[i]).norm(), 0, 1e-5) << i;
  options = {};
  options.thickness = 0.01;
  export_run(*run, scratch / "thick.obj", options);
  EXPECT_GT(read_mesh(scratch / "thick.0000.obj").mesh.face_count(), 2 * skin.face_count() - 1);
}

TEST_F(Export, RefusesUnsupportedFormats) {
  const auto kind_of = [&](const fs::path& file, const ExportOptions& options) {
    try {
      export_run(*run, file, options);
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::solver;
  };
  EXPECT_EQ(kind_of(scratch / "a.abc", {}), ErrorKind::usage);
  EXPECT_EQ(kind_of(scratch / "a", {}), ErrorKind::usage);
  EXPECT_EQ(kind_of(scratch / "a.pc2", {"sail", SurfaceKind::skin}), ErrorKind::usage);
  ExportOptions odd;
  odd.subdivide = 1;
  EXPECT_EQ(kind_of(scratch / "a.vtu", odd), ErrorKind::usage);
  odd.subdivide = 9;
  EXPECT_EQ(kind_of(scratch / "a.obj", odd), ErrorKind::usage);
  odd = {};
  odd.carry = scratch / "none.obj";
  EXPECT_EQ(kind_of(scratch / "a.obj", odd), ErrorKind::file);
  for (const char* suffix : {"pc2", "mdd", "obj", "ply", "usda", "glb", "gltf", "vtu"})
    EXPECT_EQ(kind_of(scratch / (std::string("no/such/place.") + suffix), {}), ErrorKind::file) << suffix;
}

TEST(Vtk, ImagesAndVoxelsReadBack) {
  Scratch scratch;
  VtkImage image;
  image.samples = {2, 3, 4};
  image.width = 0.5;
  image.name = "distance";
  image.values.assign(24, -0.25f);
  write_vti(scratch / "field.vti", image);
  EXPECT_THAT(bytes_of(scratch / "field.vti"),
              HasSubstr("WholeExtent=\"0 1 0 2 0 3\" Origin=\"0 0 0\" Spacing=\"0.5 0.5 0.5\""));
  const Lattice lattice = test::box_lattice({3, 2, 1});
  VtkGrid grid;
  grid.points = flat(test::rest_positions(lattice));
  for (const auto& voxel : lattice.voxel_vertices) grid.add_voxel(voxel);
  write_vtu(scratch / "voxels.vtu", grid);
  const VtkVoxels read = read_voxels(scratch / "voxels.vtu");
  EXPECT_EQ(read.voxels, lattice.voxel_vertices);
  EXPECT_EQ(read.points, test::rest_positions(lattice));
  const std::string whole = bytes_of(scratch / "voxels.vtu");
  for (std::size_t length = 0; length < whole.size(); length += 13) {
    test::write_bytes(scratch / "cut.vtu", whole.substr(0, length));
    EXPECT_THROW(read_voxels(scratch / "cut.vtu"), Error) << length;
  }
}

}  // namespace
}  // namespace muslin
