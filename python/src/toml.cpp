// TOML files with the places of their keys, for the parts of the package that are written in Python.
#include <filesystem>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "paths.hpp"
#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "muslin/core/nearest_name.hpp"
#include "muslin/core/toml_value.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muslin::python {
namespace {

/// Converts a value; `places` receives the line and column of each key under its dotted path.
nb::object convert(const TomlValue& value, const std::string& path, nb::dict& places) {
  switch (value.type) {
    case TomlValue::Type::boolean:
      return nb::bool_(value.boolean);
    case TomlValue::Type::integer:
      return nb::int_(value.integer);
    case TomlValue::Type::real:
      return nb::float_(value.real);
    case TomlValue::Type::string:
    case TomlValue::Type::date:
      return nb::str(value.string.c_str(), value.string.size());
    case TomlValue::Type::array: {
      nb::list list;
      for (const TomlValue& item : value.items) {
        const std::string own = fmt::format("{}[{}]", path, nb::len(list));
        places[own.c_str()] = nb::make_tuple(item.place.line, item.place.column);
        list.append(convert(item, own, places));
      }
      return list;
    }
    case TomlValue::Type::table:
      break;
  }
  nb::dict table;
  for (std::size_t i = 0; i < value.items.size(); ++i) {
    const TomlValue& item = value.items[i];
    const std::string own = path.empty() ? value.keys[i] : fmt::format("{}.{}", path, value.keys[i]);
    places[own.c_str()] = nb::make_tuple(item.key_place.line, item.key_place.column);
    table[value.keys[i].c_str()] = convert(item, own, places);
  }
  return table;
}

}  // namespace

void bind_toml(nb::module_& m) {
  m.def(
      "_read_toml",
      [](const FilePath& file) {
        const std::filesystem::path& path = file;
        nb::dict places;
        const nb::object tables = convert(parse_toml(read_text(path), path.string()), "", places);
        return nb::make_tuple(tables, places);
      },
      "file"_a,
      "Returns the tables of a file, and the line and column of each key by its dotted path; items of lists "
      "as KEY[0].");
  m.def(
      "_name_advice",
      [](const std::string& name, const std::vector<std::string>& names) { return name_advice(name, names); },
      "name"_a, "names"_a, "Returns the remedy for an unknown name.");
}

}  // namespace muslin::python
