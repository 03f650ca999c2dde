#include "muslin/io/assimp_reader.hpp"

#include <algorithm>

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "muslin/core/error.hpp"
#include "muslin/io/isolated.hpp"
#include "muslin/io/mesh_bytes.hpp"
#include "muslin/io/node_mesh.hpp"

namespace muslin {
namespace {

class AssimpReader {
 public:
  AssimpReader(const std::string& suffix, const std::string& file)
      : suffix_(suffix), file_(file), out_(file) {}

  MeshFile read(std::string_view bytes) {
    check_content(bytes);
    Assimp::Importer importer;
    // Geometry only, and every node as one transform instead of FBX's chain of pivots.
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_ANIMATIONS, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_MATERIALS, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_TEXTURES, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_LIGHTS, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_CAMERAS, false);
    const aiScene* scene = nullptr;
    std::string problem;
    try {
      scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, suffix_.c_str() + 1);
      problem = importer.GetErrorString();
    } catch (const std::exception& exception) {
      problem = exception.what();
    }
    if (scene == nullptr || scene->mRootNode == nullptr) {
      std::replace(problem.begin(), problem.end(), '\n', ' ');
      refuse("the file cannot be read: " + problem.substr(0, 200), "export it again, preferably as OBJ");
    }
    visit(*scene, scene->mRootNode, to_metres(*scene));
    std::string extra =
        " Vertex order is not that of the file, and positions have the precision of float." + units_;
    if (skipped_ > 0) extra += " Points and lines were left out.";
    return out_.finish(
        suffix_ == ".fbx" ? "FBX is read with its corners apart" : "Collada is read with its corners apart",
        extra);
  }

 private:
  [[noreturn]] void refuse(const std::string& problem, const std::string& remedy) const {
    throw Error(ErrorKind::input, Place{file_}, problem, remedy);
  }

  // assimp tries every format it knows if the suffix's own does not fit.
  void check_content(std::string_view bytes) const {
    const std::string_view head = bytes.substr(0, 4096);
    const bool fits = suffix_ == ".dae"
                          ? head.find("<COLLADA") != head.npos
                          : head.starts_with("Kaydara FBX Binary") || head.find("; FBX") != head.npos ||
                                head.find("FBXHeaderExtension") != head.npos;
    if (!fits)
      refuse(suffix_ == ".dae" ? "this is not a Collada file: it has no COLLADA element"
                               : "this is not an FBX file",
             "give the file the suffix of its real format, or export it again");
  }

  // assimp applies Collada's unit and up axis itself, but only reports those of FBX.
  Eigen::Matrix4d to_metres(const aiScene& scene) {
    Eigen::Matrix4d transform = Eigen::Matrix4d::Identity();
    if (suffix_ == ".dae") {
      units_ = " Unit and up axis of the file were applied.";
      return transform;
    }
    double centimetres = 1;
    int up = 1, sign = 1;
    if (scene.mMetaData != nullptr) {
      float single = 0;
      if (!scene.mMetaData->Get("UnitScaleFactor", centimetres) &&
          scene.mMetaData->Get("UnitScaleFactor", single))
        centimetres = static_cast<double>(single);
      scene.mMetaData->Get("UpAxis", up);
      scene.mMetaData->Get("UpAxisSign", sign);
    }
    if (!(centimetres > 1e-6 && centimetres < 1e9))
      refuse("the unit of the file is invalid", "export it again");
    Mat3 turn = Mat3::Identity();
    const double s = sign < 0 ? -1 : 1;
    if (up == 2)
      turn << 1, 0, 0, 0, 0, s, 0, -s, 0;  // z up: (x, y, z) becomes (x, z, −y)
    else if (up == 0)
      turn << 0, -s, 0, s, 0, 0, 0, 0, 1;  // x up: (x, y, z) becomes (−y, x, z)
    else if (s < 0)
      turn << -1, 0, 0, 0, -1, 0, 0, 0, 1;
    transform.topLeftCorner<3, 3>() = turn * centimetres / 100;
    std::string factor = std::to_string(centimetres / 100);
    factor.erase(factor.find_last_not_of('0') + 1);
    if (factor.ends_with('.')) factor += '0';
    units_ = " Scaled by " + factor + " to metres" + (up == 1 && s > 0 ? "." : " and turned to y up.");
    return transform;
  }

  void visit(const aiScene& scene, const aiNode* root, const Eigen::Matrix4d& outer) {
    std::vector<std::pair<const aiNode*, Eigen::Matrix4d>> pending{{root, outer}};
    while (!pending.empty()) {
      const auto [node, parent] = pending.back();
      pending.pop_back();
      Eigen::Matrix4d local;
      for (unsigned row = 0; row < 4; ++row)
        for (unsigned column = 0; column < 4; ++column)
          local(row, column) = static_cast<double>(node->mTransformation[row][column]);
      const Eigen::Matrix4d transform = parent * local;
      if (node->mNumMeshes > 0) out_.begin_node(node->mName.C_Str(), transform);
      for (unsigned m = 0; m < node->mNumMeshes; ++m) part(*scene.mMeshes[node->mMeshes[m]]);
      for (unsigned c = node->mNumChildren; c-- > 0;) pending.push_back({node->mChildren[c], transform});
    }
  }

  void part(const aiMesh& mesh) {
    if (mesh.mVertices == nullptr) return;
    const bool has_uvs = mesh.HasTextureCoords(0);
    out_.begin_part(mesh.mNumVertices, has_uvs ? mesh.mNumVertices : 0);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v)
      out_.position(
          Eigen::Vector3f(mesh.mVertices[v].x, mesh.mVertices[v].y, mesh.mVertices[v].z).cast<double>());
    for (unsigned v = 0; has_uvs && v < mesh.mNumVertices; ++v)
      out_.uv(Eigen::Vector2f(mesh.mTextureCoords[0][v].x, mesh.mTextureCoords[0][v].y).cast<double>());
    std::vector<std::size_t> corners;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices < 3) {
        ++skipped_;
        continue;
      }
      corners.assign(face.mIndices, face.mIndices + face.mNumIndices);
      out_.face(corners);
    }
  }

  std::string suffix_, file_;
  NodeMesh out_;
  std::string units_;
  std::size_t skipped_ = 0;
};

}  // namespace

/// Damaged files crash the library, or keep it busy without end.
MeshFile read_with_assimp(std::string_view bytes, const std::string& suffix, const std::string& file) {
  try {
    return from_bytes(run_isolated([&] { return to_bytes(AssimpReader(suffix, file).read(bytes)); }));
  } catch (const IsolatedFailure& failure) {
    throw Error(ErrorKind::input, Place{file},
                std::string("the library that reads this format cannot read the file: ") + failure.what(),
                "it is damaged, or very large: export it again, preferably as OBJ");
  }
}

}  // namespace muslin
