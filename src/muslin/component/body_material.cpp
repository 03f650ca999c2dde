#include "muslin/component/body_material.hpp"

#include <utility>
#include <vector>

#include "muslin/core/nearest_name.hpp"

namespace muslin {
namespace {

using schema::Key;

/// A name of the library or the path of a material file.
Material find_or_read(const std::string& name, const Place& place, const std::filesystem::path& folder) {
  try {
    return name.ends_with(".toml") ? read_material(folder / name) : find_material(name);
  } catch (const Error& error) {
    if (!error.place().file.empty() && error.kind() == ErrorKind::input) throw;  // inside the material file
    const std::string file = error.place().file.empty() ? "" : error.place().file + ": ";
    throw Error(error.kind(), place, file + error.problem(), error.remedy());
  }
}

Material named_material(const MaterialUse& use, const std::string& name, const Place& place,
                        const std::filesystem::path& folder) {
  Material material = find_or_read(name, place, folder);
  if (use.has_numbers(material)) return material;
  std::vector<std::string> fit;
  for (const std::string& other : material_names())
    if (use.has_numbers(find_material(other))) fit.push_back(other);
  throw Error(ErrorKind::input, place,
              fmt::format("the material `{}` has no numbers for a {}", material.name, use.kind),
              "take one of " + name_list(fit) + ", or an inline table");
}

/// The resolved scene has the name of the material first.
TomlValue with_name(const std::string& name, TomlValue numbers) {
  TomlValue result;
  schema::append(result, "name", schema::words(name));
  for (std::size_t i = 0; i < numbers.keys.size(); ++i)
    schema::append(result, numbers.keys[i], std::move(numbers.items[i]));
  return result;
}

}  // namespace

void write_material(const MaterialUse& use, const Key& key, const Material& material, TomlValue& out) {
  if (use.has_numbers(material)) schema::append(out, key.name, with_name(material.name, use.write(material)));
}

void check_material(const MaterialUse& use, const Key& key, const Material& material,
                    const schema::Subject& subject) {
  if (!use.has_numbers(material))
    throw subject.error(key.name, fmt::format("its material has no numbers for {}", use.plural), use.remedy);
  use.check(material, subject);
}

Material material_of(const MaterialUse& use, const TomlTable& table, const BodySettings& body,
                     const std::filesystem::path& folder) {
  const TomlValue& value = *table.find("material");
  if (value.type == TomlValue::Type::string) return named_material(use, value.string, value.place, folder);
  if (value.type != TomlValue::Type::table) {
    throw table.error("material",
                      fmt::format("`material` of {} is neither a name nor a table", table.title()),
                      fmt::format("write material = \"cotton\" or a table {{ … }} with {}", use.quantities));
  }
  return use.read(use.keys().open(value, fmt::format("`material` of {}", table.title())), body, folder);
}

Material base_material(const MaterialUse& use, const TomlTable& table, const std::filesystem::path& folder) {
  return named_material(use, table.string("base"), table.place("base"), folder);
}

}  // namespace muslin
