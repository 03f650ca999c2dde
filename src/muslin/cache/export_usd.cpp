#include <cctype>
#include <map>
#include <set>
#include <string>

#include <fmt/format.h>

#include "muslin/cache/export_formats.hpp"
#include "muslin/core/output_file.hpp"

namespace muslin {
namespace {

namespace fs = std::filesystem;

/// Returns a valid USD name: letters, digits, underscores, no digit in front; unique among `taken`.
std::string identifier(const std::string& name, std::set<std::string>& taken) {
  std::string result;
  for (char c : name) result += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  if (result.empty() || std::isdigit(static_cast<unsigned char>(result.front()))) result = "_" + result;
  std::string unique = result;
  for (int i = 2; !taken.insert(unique).second; ++i) unique = result + "_" + std::to_string(i);
  return unique;
}

std::string escaped(const std::string& text) {
  std::string result;
  for (char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c == '\n' || c == '\r' ? ' ' : c;
  }
  return result;
}

template <class Range, class Format>
std::string list(const Range& range, const Format& format) {
  std::string text = "[";
  for (const auto& item : range) {
    if (text.size() > 1) text += ", ";
    text += format(item);
  }
  return text + "]";
}

std::string ints(const std::vector<int>& values) {
  return list(values, [](int value) { return std::to_string(value); });
}
std::string vectors(const std::vector<Vec3f>& values) {
  return list(values, [](const Vec3f& v) { return fmt::format("({}, {}, {})", v.x(), v.y(), v.z()); });
}

void append_topology(WholeFile& out, const Mesh& mesh) {
  std::vector<int> counts;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) counts.push_back(static_cast<int>(mesh.face(f).size()));
  out.append("        uniform token subdivisionScheme = \"none\"\n        uniform bool doubleSided = 1\n");
  out.append("        int[] faceVertexCounts = " + ints(counts) + "\n");
  out.append("        int[] faceVertexIndices = " + ints(mesh.face_vertices) + "\n");
  if (mesh.corner_uvs.empty()) return;
  std::vector<Vec2> uvs = mesh.uvs;
  std::vector<int> indices = mesh.corner_uvs;
  for (int& index : indices) {
    if (index >= 0) continue;
    if (uvs.size() == mesh.uvs.size()) uvs.push_back(Vec2::Zero());  // of corners that have none
    index = static_cast<int>(mesh.uvs.size());
  }
  out.append("        texCoord2f[] primvars:st = " +
             list(uvs,
                  [](const Vec2& uv) {
                    return fmt::format("({}, {})", static_cast<float>(uv.x()), static_cast<float>(uv.y()));
                  }) +
             " (\n            interpolation = \"faceVarying\"\n        )\n");
  out.append("        int[] primvars:st:indices = " + ints(indices) + "\n");
}

void append_subset(WholeFile& out, const std::string& opening, const std::string& family,
                   const std::vector<int>& faces, const std::string& more) {
  out.append(fmt::format("\n        def GeomSubset {}\n        {{\n", opening));
  out.append("            uniform token elementType = \"face\"\n");
  out.append(fmt::format("            uniform token familyName = \"{}\"\n", family));
  out.append("            int[] indices = " + ints(faces) + "\n" + more + "        }\n");
}

/// Writes the groups and the faces of each material, bound to the materials of the run, `materials`: name →
/// identifier.
void append_subsets(WholeFile& out, const Mesh& mesh, const std::map<std::string, std::string>& materials) {
  std::set<std::string> taken;
  for (const MeshGroup& group : mesh.groups)
    if (!group.faces.empty())
      append_subset(out, '"' + identifier(group.name, taken) + '"', "groups", group.faces, "");
  if (!mesh.materials.empty())
    out.append("\n        uniform token subsetFamily:materialBind:familyType = \"nonOverlapping\"\n");
  for (const MeshMaterial& material : mesh.materials)
    append_subset(
        out,
        fmt::format("\"{}\" (\n            prepend apiSchemas = [\"MaterialBindingAPI\"]\n        )",
                    identifier(material.name, taken)),
        "materialBind", material.faces,
        fmt::format("            rel material:binding = </run/materials/{}>\n", materials.at(material.name)));
}

/// Writes the materials of all surfaces, of the same plain surface; returns name → identifier.
std::map<std::string, std::string> append_materials(WholeFile& out, std::span<ExportedSurface> surfaces,
                                                    std::set<std::string>& taken_in_run) {
  std::map<std::string, std::string> materials;
  std::set<std::string> taken;
  for (const ExportedSurface& surface : surfaces)
    for (const MeshMaterial& material : surface.mesh().materials)
      if (!materials.contains(material.name)) materials[material.name] = identifier(material.name, taken);
  if (materials.empty()) return materials;
  taken_in_run.insert("materials");
  out.append("    def Scope \"materials\"\n    {\n");
  for (const auto& [name, id] : materials) {
    out.append(fmt::format(
        "        def Material \"{}\" (\n            displayName = \"{}\"\n        )\n        {{\n", id,
        escaped(name)));
    out.append(fmt::format(
        "            token outputs:surface.connect = </run/materials/{}/surface.outputs:surface>\n\n", id));
    out.append(
        "            def Shader \"surface\"\n            {\n"
        "                uniform token info:id = \"UsdPreviewSurface\"\n"
        "                float inputs:roughness = 0.9\n"
        "                token outputs:surface\n            }\n        }\n");
  }
  out.append("    }\n");
  return materials;
}

template <class At>
void append_samples(WholeFile& out, const std::string& attribute, int frames, const At& at) {
  out.append("        " + attribute + ".timeSamples = {\n");
  for (int frame = 0; frame < frames; ++frame)
    out.append(fmt::format("            {}: {},\n", frame, at(frame)));
  out.append("        }\n");
}

}  // namespace

void export_usd(const RunReader& run, const fs::path& file, std::span<ExportedSurface> surfaces,
                const Progress& progress) {
  const int frames = run.frame_count();
  WholeFile out(file);
  out.append(
      fmt::format("#usda 1.0\n(\n    defaultPrim = \"run\"\n    doc = \"{}\"\n    endTimeCode = {}\n"
                  "    framesPerSecond = {}\n    metersPerUnit = 1\n    startTimeCode = 0\n"
                  "    timeCodesPerSecond = {}\n    upAxis = \"Y\"\n)\n\n",
                  escaped(run.title()), frames - 1, run.frame_rate(), run.frame_rate()));
  out.append("def Xform \"run\" (\n    kind = \"component\"\n)\n{\n");
  std::set<std::string> taken;
  const std::map<std::string, std::string> materials = append_materials(out, surfaces, taken);
  double done = 0;
  for (ExportedSurface& surface : surfaces) {
    const Mesh& mesh = surface.mesh();
    const std::string bound =
        mesh.materials.empty() ? "" : " (\n        prepend apiSchemas = [\"MaterialBindingAPI\"]\n    )";
    out.append(fmt::format("    def Mesh \"{}\"{}\n    {{\n", identifier(surface.name(), taken), bound));
    append_topology(out, mesh);
    std::vector<Vec3f> extents;
    append_samples(out, "point3f[] points", frames, [&](int frame) {
      progress.at(done / (2.0 * frames * static_cast<double>(surfaces.size())), "export");
      ++done;
      const std::vector<Vec3f> points = surface.points(frame);
      Eigen::AlignedBox3f box;
      for (const Vec3f& p : points) box.extend(p);
      extents.push_back(box.min());
      extents.push_back(box.max());
      return vectors(points);
    });
    append_samples(out, "vector3f[] velocities", frames, [&](int frame) {
      progress.at(done / (2.0 * frames * static_cast<double>(surfaces.size())), "export");
      ++done;
      return vectors(surface.velocities(frame));
    });
    append_samples(out, "float3[] extent", frames, [&](int frame) {
      const auto first = extents.begin() + 2 * frame;
      return vectors({first[0], first[1]});
    });
    append_subsets(out, mesh, materials);
    out.append("    }\n");
  }
  out.append("}\n");
  out.commit();
}

}  // namespace muslin
