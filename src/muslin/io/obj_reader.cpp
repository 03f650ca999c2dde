#include "muslin/io/obj_reader.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <unordered_map>

#include "muslin/io/groups.hpp"
#include "muslin/io/text_scanner.hpp"

namespace muslin {
namespace {

// Ignored statements, unrelated to positions, polygons, texture coordinates, groups or materials.
constexpr std::array ignored = {"vn",    "vp",    "s",        "mtllib",   "usemap", "maplib",     "mg",
                                "deg",   "bmat",  "step",     "cstype",   "curv",   "curv2",      "surf",
                                "parm",  "trim",  "hole",     "scrv",     "sp",     "end",        "con",
                                "bevel", "lod",   "c_interp", "d_interp", "call",   "shadow_obj", "trace_obj",
                                "ctech", "stech", "csh",      "l"};

constexpr std::size_t max_names = 256;  // on one `g` statement; bounds the memory a small file can ask for

class ObjReader {
 public:
  ObjReader(std::string_view text, const std::string& file) : scanner_(text, file, TextScanner::Syntax::obj) {
    mesh_.face_offsets.push_back(0);
    runs_.push_back({});
  }

  MeshFile read() {
    do {
      statement(scanner_.word());
    } while (scanner_.next_line());
    check_forward(forward_vertices_, mesh_.positions.size(), "vertex");
    check_forward(forward_uvs_, mesh_.uvs.size(), "texture coordinate");
    if (!has_uvs_) mesh_.corner_uvs.clear();
    if (mesh_.face_count() == 0) mesh_.face_offsets.clear();
    collect_groups();
    mesh_.materials = materials();
    MeshFile file{{}, note(), {}};
    if (colours_[0].values.size() == mesh_.positions.size() && !mesh_.positions.empty())
      file.attributes.assign(colours_.begin(), colours_.end());
    file.mesh = std::move(mesh_);
    return file;
  }

 private:
  // Consecutive faces with the same object, groups and material.
  struct Run {
    std::size_t first_face = 0;
    int object = -1;
    int material = -1;
    std::vector<int> groups;
  };
  // An index that was beyond the list when it was read; only records are kept, so the first bad one is there.
  struct Forward {
    std::int64_t index;
    int line;
  };

  void statement(std::string_view keyword) {
    if (keyword.empty()) return;
    if (keyword == "v") {
      const double x = scanner_.coordinate(scanner_.word()), y = scanner_.coordinate(scanner_.word());
      mesh_.positions.push_back({x, y, scanner_.coordinate(scanner_.word())});
      colour();
      check_count(mesh_.positions.size());
    } else if (keyword == "f" || keyword == "fo") {
      face();
    } else if (keyword == "vt") {
      const double u = scanner_.texture_coordinate(scanner_.word());
      const std::string_view second = scanner_.word();
      mesh_.uvs.push_back({u, second.empty() ? 0 : scanner_.texture_coordinate(second)});
      check_count(mesh_.uvs.size());
    } else if (keyword == "g") {
      groups();
    } else if (keyword == "o") {
      const std::string_view name = scanner_.rest_of_line();
      start_run().object = name.empty() ? -1 : identify(std::string(name), object_ids_, object_names_);
    } else if (keyword == "usemtl") {
      const std::string_view name = scanner_.rest_of_line();
      start_run().material = name.empty() ? -1 : identify(std::string(name), material_ids_, material_names_);
    } else if (keyword == "p") {
      points();
    } else if (std::find(ignored.begin(), ignored.end(), keyword) != ignored.end()) {
      left_out_ += keyword == "l" || keyword == "curv" || keyword == "surf";
    } else {
      unknown(keyword);
      return;
    }
    known_ = true;
  }

  void unknown(std::string_view keyword) {
    if (!known_)
      scanner_.fail(keyword, "this is not a Wavefront OBJ file: no statement begins like this",
                    "give the file the suffix of its real format, or export it as OBJ");
    if (unknown_++ == 0) first_unknown_ = scanner_.line();
  }

  void check_count(std::size_t count) const {
    if (count > static_cast<std::size_t>(std::numeric_limits<int>::max() - 1))
      scanner_.fail({}, "the mesh is too large",
                    "split it into parts of less than two thousand million entries");
  }

  /// Red, green and blue behind a position; one number there is a weight, which has no use.
  void colour() {
    std::array<std::string_view, 3> words;
    for (std::string_view& word : words) word = scanner_.word();
    if (words[2].empty()) return;
    for (std::size_t i = 0; i < 3; ++i) colours_[i].values.push_back(scanner_.number(words[i], "a colour"));
  }

  // A word "v", "v/t", "v//n" or "v/t/n"; the normal is only checked for being a number.
  void face() {
    std::size_t corners = 0;
    for (std::string_view word = scanner_.word(); !word.empty(); word = scanner_.word(), ++corners) {
      const std::size_t slash = word.find('/');
      mesh_.face_vertices.push_back(
          resolve(word.substr(0, slash), mesh_.positions.size(), forward_vertices_, "vertex"));
      int uv = -1;
      if (slash != word.npos) {
        const std::string_view rest = word.substr(slash + 1);
        const std::size_t second = rest.find('/');
        const std::string_view texture = rest.substr(0, second);
        if (!texture.empty()) uv = resolve(texture, mesh_.uvs.size(), forward_uvs_, "texture coordinate");
        if (second != rest.npos && second + 1 < rest.size())
          scanner_.integer(rest.substr(second + 1), "the index of a normal");
      }
      has_uvs_ |= uv >= 0;
      mesh_.corner_uvs.push_back(uv);
    }
    if (corners < 3)
      scanner_.fail({}, "a face has " + std::to_string(corners) + (corners == 1 ? " corner" : " corners"),
                    "a face needs three or more: repair the mesh or export it again");
    check_count(mesh_.face_vertices.size());
    mesh_.face_offsets.push_back(static_cast<int>(mesh_.face_vertices.size()));
  }

  int resolve(std::string_view word, std::size_t count, std::vector<Forward>& forward, const char* what) {
    const std::int64_t index = scanner_.integer(word, "an index");
    const auto size = static_cast<std::int64_t>(count);
    if (index > 0 && index <= size) return static_cast<int>(index - 1);
    if (index == 0 || index < -size)
      scanner_.fail(word,
                    "a face uses " + std::string(what) + " " + std::to_string(index) + ", " +
                        (index == 0 ? "but counting starts at 1"
                                    : "but there are only " + std::to_string(size) + " before it"),
                    "the file is damaged: export it again");
    if (index < 0) return static_cast<int>(size + index);
    if (index > std::numeric_limits<int>::max() - 1)
      scanner_.fail(word, range_problem(what, index, size), "the file is damaged: export it again");
    if (forward.empty() || index > forward.back().index) forward.push_back({index, scanner_.line()});
    return static_cast<int>(index - 1);
  }

  static std::string range_problem(const char* what, std::int64_t index, std::int64_t count) {
    return "a face uses " + std::string(what) + " " + std::to_string(index) + ", but there are " +
           std::to_string(count);
  }

  void check_forward(const std::vector<Forward>& forward, std::size_t count, const char* what) const {
    for (const Forward& use : forward)
      if (use.index > static_cast<std::int64_t>(count))
        scanner_.fail_at(use.line, range_problem(what, use.index, static_cast<std::int64_t>(count)),
                         "the file is damaged or cut off: export it again");
  }

  void groups() {
    std::vector<int> active;
    for (std::string_view word = scanner_.word(); !word.empty(); word = scanner_.word()) {
      const int group = identify(std::string(word), group_ids_, group_names_);
      if (std::find(active.begin(), active.end(), group) == active.end()) active.push_back(group);
      if (active.size() > max_names)
        scanner_.fail(word, "a group statement names more than " + std::to_string(max_names) + " groups",
                      "export the file with fewer groups");
    }
    start_run().groups = std::move(active);
  }

  void points() {
    for (std::string_view word = scanner_.word(); !word.empty(); word = scanner_.word()) {
      const int vertex = resolve(word, mesh_.positions.size(), forward_vertices_, "vertex");
      for (const int group : runs_.back().groups) points_.push_back({group, vertex});
    }
  }

  Run& start_run() {
    if (runs_.back().first_face != mesh_.face_count()) {
      runs_.push_back(runs_.back());
      runs_.back().first_face = mesh_.face_count();
    }
    return runs_.back();
  }

  static int identify(std::string name, std::unordered_map<std::string, int>& ids,
                      std::vector<std::string>& names) {
    const auto [entry, is_new] = ids.try_emplace(std::move(name), static_cast<int>(names.size()));
    if (is_new) names.push_back(entry->first);
    return entry->second;
  }

  // Groups come in the order of their first face, so that writing and reading again gives the same order.
  void collect_groups() {
    runs_.push_back({mesh_.face_count(), -1, -1, {}});
    int only = -2;  // the object of all faces so far; −2 none yet
    bool several = false;
    for (std::size_t r = 0; r + 1 < runs_.size(); ++r) {
      if (runs_[r].first_face == runs_[r + 1].first_face) continue;
      several |= only != -2 && only != runs_[r].object;
      only = runs_[r].object;
    }
    if (!several && only >= 0) mesh_.name = object_names_[static_cast<std::size_t>(only)];

    std::vector<int> index(group_names_.size(), -1);
    const auto group = [&](int id) -> MeshGroup& {
      if (static_cast<std::size_t>(id) >= index.size()) index.resize(static_cast<std::size_t>(id) + 1, -1);
      int& at = index[static_cast<std::size_t>(id)];
      if (at < 0) {
        at = static_cast<int>(mesh_.groups.size());
        mesh_.groups.push_back({group_names_[static_cast<std::size_t>(id)], {}, {}});
      }
      return mesh_.groups[static_cast<std::size_t>(at)];
    };
    for (std::size_t r = 0; r + 1 < runs_.size(); ++r) {
      if (runs_[r].first_face == runs_[r + 1].first_face) continue;
      std::vector<int> ids = runs_[r].groups;
      if (several && runs_[r].object >= 0)
        ids.insert(ids.begin(), identify(one_word(object_names_[static_cast<std::size_t>(runs_[r].object)]),
                                         group_ids_, group_names_));
      for (const int id : ids) {
        std::vector<int>& faces = group(id).faces;
        for (std::size_t f = runs_[r].first_face; f < runs_[r + 1].first_face; ++f)
          faces.push_back(static_cast<int>(f));
      }
    }
    for (const auto& [id, vertex] : points_) group(id).vertices.push_back(vertex);
    for (MeshGroup& each : mesh_.groups) complete_group(mesh_, each);
  }

  /// The runs must be complete.
  std::vector<MeshMaterial> materials() const {
    std::vector<MeshMaterial> result;
    result.reserve(material_names_.size());
    for (const std::string& name : material_names_) result.push_back({name, {}});
    for (std::size_t r = 0; r + 1 < runs_.size(); ++r) {
      if (runs_[r].material < 0) continue;
      std::vector<int>& faces = result[static_cast<std::size_t>(runs_[r].material)].faces;
      for (std::size_t f = runs_[r].first_face; f < runs_[r + 1].first_face; ++f)
        faces.push_back(static_cast<int>(f));
    }
    std::erase_if(result, [](const MeshMaterial& material) { return material.faces.empty(); });
    return result;
  }

  std::string note() const {
    std::string text;
    if (left_out_ > 0) text += std::to_string(left_out_) + " lines, curves or surfaces were left out. ";
    if (unknown_ > 0)
      text += std::to_string(unknown_) + " unknown statements were skipped, the first on line " +
              std::to_string(first_unknown_) + ". ";
    if (!text.empty()) text.pop_back();
    return text;
  }

  TextScanner scanner_;
  Mesh mesh_;
  bool known_ = false, has_uvs_ = false;
  std::vector<Forward> forward_vertices_, forward_uvs_;
  std::vector<Run> runs_;
  std::vector<std::pair<int, int>> points_;  // group, vertex
  std::unordered_map<std::string, int> group_ids_, object_ids_, material_ids_;
  std::vector<std::string> group_names_, object_names_, material_names_;
  std::array<VertexAttribute, 3> colours_ = {{{"red", {}}, {"green", {}}, {"blue", {}}}};
  std::size_t left_out_ = 0, unknown_ = 0;
  int first_unknown_ = 0;
};

}  // namespace

MeshFile read_obj(std::string_view text, const std::string& file) { return ObjReader(text, file).read(); }

}  // namespace muslin
