#include "muslin/report/fabric_sources.hpp"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "muslin/core/error.hpp"
#include "muslin/core/toml_value.hpp"
#include "muslin/material/library.hpp"
#include "muslin/material/material.hpp"
#include "muslin/material/material_table.hpp"
#include "muslin/material/shell_material.hpp"
#include "muslin/report/json_list.hpp"
#include "muslin/scene/scene.hpp"
#include "muslin/schema/table.hpp"

namespace muslin {
namespace {

using Json = nlohmann::ordered_json;

/// The scene as its file has it, before --set.
struct WrittenScene {
  TomlValue text;
  Json resolved;  ///< null if the scene cannot be read here, as its material files are elsewhere
};

WrittenScene read_written(const std::string& text, const std::filesystem::path& file) {
  WrittenScene written;
  try {
    written.text = parse_toml(text, file.string());
    written.resolved = Json::parse(parse_scene(text, file).resolved, nullptr, false);
  } catch (const Error&) {
    written.resolved = nullptr;
  }
  return written;
}

/// The value of `material` of a body in the scene file; null if there is none.
const TomlValue* written_material(const WrittenScene& scene, std::size_t body) {
  const TomlValue* bodies = scene.text.find("body");
  if (bodies == nullptr || bodies->type != TomlValue::Type::array || body >= bodies->items.size())
    return nullptr;
  return bodies->items[body].find("material");
}

/// A material file, as text.
struct MaterialFile {
  bool in_library = false;
  TomlValue content;
  std::vector<std::string> guesses;

  bool has(const std::string& table, const std::string& key) const {
    const TomlValue* numbers = content.find(table);
    return numbers != nullptr && numbers->find(key) != nullptr;
  }
  bool lists_as_guess(const std::string& name) const {
    return std::find(guesses.begin(), guesses.end(), name) != guesses.end();
  }
  std::string words(const char* key) const {
    const TomlValue* value = content.find(key);
    return value == nullptr ? "" : value->string;
  }
};

MaterialFile open_material(bool in_library, std::string_view text, const std::string& name) {
  return {in_library, parse_toml(text, name), parse_material(text, name).guesses};
}

/// Finds the file of the material that the run names, or that its scene names by a path; nothing for a table
/// without a base, or a file that is not there any more.
std::optional<MaterialFile> find_file(const std::filesystem::path& folder, const std::string& name,
                                      const std::string& written_name) {
  try {
    if (written_name.ends_with(".toml")) {
      const std::filesystem::path path = folder / written_name;
      return open_material(false, read_text(path), path.string());
    }
    for (const LibraryMaterial& material : material_library())
      if (material.name == name) return open_material(true, material.text, name);
  } catch (const Error&) {
    // The report does without the words of a file that is gone or damaged.
  }
  return std::nullopt;
}

/// The name of a material, or of the base of a table; empty: none.
std::string name_in(const TomlValue* written) {
  if (written == nullptr) return "";
  const TomlValue* name = written->type == TomlValue::Type::table ? written->find("base") : written;
  return name == nullptr ? "" : name->string;
}

/// Traces the numbers of one body.
class Tracer {
 public:
  Tracer(const Json& recorded, const Json& reread, const TomlValue* written, std::string table,
         std::optional<MaterialFile> file, bool by_path)
      : recorded_(recorded),
        reread_(reread),
        written_(written),
        table_(std::move(table)),
        file_(std::move(file)),
        by_path_(by_path) {}

  NumberOrigin origin(const std::string& key) const {
    const bool other_material = reread_.is_object() && reread_.value("name", Json()) != recorded_["name"];
    if (!other_material) {
      if (reread_.is_object() && reread_.value(key, Json()) != recorded_[key]) return NumberOrigin::changed;
      if (written_ != nullptr && written_->type == TomlValue::Type::table && written_->find(key) != nullptr)
        return NumberOrigin::scene;
    }
    if (file_ && file_->has(table_, key))
      return file_->in_library ? NumberOrigin::library : NumberOrigin::file;
    if (by_path_ && !file_) return NumberOrigin::unread;
    return other_material && !file_ ? NumberOrigin::changed : NumberOrigin::derived;
  }

  bool is_guess(const std::string& key) const {
    const NumberOrigin from = origin(key);
    return (from == NumberOrigin::library || from == NumberOrigin::file) && file_ &&
           file_->lists_as_guess(table_ + "." + key);
  }

 private:
  const Json& recorded_;
  Json reread_;
  const TomlValue* written_;
  std::string table_;
  std::optional<MaterialFile> file_;
  bool by_path_;
};

Fabric trace(const std::filesystem::path& folder, const Json& body, const Json& reread,
             const TomlValue* written) {
  const Json& material = body["material"];
  Fabric fabric;
  fabric.body = body.value("name", "");
  fabric.model = body.value("model", "");
  fabric.material = material.value("name", "");
  const bool shell = fabric.model == "shell";
  const std::string written_name = name_in(written);
  std::optional<MaterialFile> file = find_file(folder, fabric.material, written_name);
  if (file) {
    fabric.description = file->words("description");
    fabric.source = file->words("source");
  }
  const schema::Table& keys = shell ? shell_material_table() : lattice_material_table();
  const Tracer tracer(material, reread, written, shell ? "shell" : "lattice", std::move(file),
                      written_name.ends_with(".toml"));
  for (const auto& [key, value] : material.items()) {
    const schema::Key* declared = keys.find(key);
    if (declared == nullptr || !(value.is_number() || value.is_array())) continue;
    FabricNumber number{key, declared->unit,     declared->meaning,   0,
                        {},  tracer.origin(key), tracer.is_guess(key)};
    if (value.is_number()) number.value = value.get<double>();
    for (const Json& point : value.is_array() ? value : Json::array())
      number.curve.emplace_back(point.at(0).get<double>(), point.at(1).get<double>());
    fabric.numbers.push_back(std::move(number));
  }
  return fabric;
}

}  // namespace

const char* name_of(NumberOrigin origin) {
  switch (origin) {
    case NumberOrigin::library:
      return "from the material library";
    case NumberOrigin::file:
      return "from the material file";
    case NumberOrigin::unread:
      return "from a material file that was not found again, or derived";
    case NumberOrigin::scene:
      return "from the scene file";
    case NumberOrigin::changed:
      return "overridden by --set or a program";
    case NumberOrigin::derived:
      return "derived or default";
  }
  return "";
}

std::vector<Fabric> trace_fabrics(const RunReader& run, const std::string& scene_text,
                                  const std::filesystem::path& scene_file) {
  const Json recorded = Json::parse(run.resolved_scene(), nullptr, false);
  const Json& bodies = json_list(recorded, "body");
  const WrittenScene written = read_written(scene_text, scene_file);
  const Json& reread = json_list(written.resolved, "body");
  std::vector<Fabric> fabrics;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!bodies[b].is_object() || !bodies[b].value("material", Json()).is_object()) continue;
    const Json before = b < reread.size() ? reread[b].value("material", Json()) : Json();
    fabrics.push_back(trace(scene_file.parent_path(), bodies[b], before, written_material(written, b)));
  }
  return fabrics;
}

}  // namespace muslin
