#include <cctype>

#include <fmt/format.h>

#include "muslin/schema/publish.hpp"
#include "muslin/schema/walk.hpp"

namespace muslin::schema {
namespace {

/// "material_of_a_shell" → "MaterialOfAShell".
std::string class_name(const std::string& plain) {
  std::string name;
  bool upper = true;
  for (const char c : plain) {
    if (!std::isalnum(static_cast<unsigned char>(c))) {
      upper = true;
      continue;
    }
    name += upper ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    upper = false;
  }
  return name;
}

std::string class_name(const Table& table) { return class_name(plain_name(table)); }
std::string class_name(const Shape& shape) { return class_name(shape.word()) + class_name(*shape.table); }

std::string literal(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", word);
  return fmt::format("Literal[{}]", text);
}

std::string type_of(const Key& key, Type type) {
  switch (type) {
    case Type::number:
      return "float";
    case Type::whole_number:
      return "int";
    case Type::truth:
      return "bool";
    case Type::text:
      return "str";
    case Type::texts:
      if (key.table == nullptr) return "Sequence[str]";
      return fmt::format("Sequence[Union[str, \"{}\"]]", class_name(key.table()));
    case Type::path:
      return "Path";
    case Type::word:
      return literal(key.choices);
    case Type::vector:
      return "Vector";
    case Type::points:
    case Type::curve:
      return "Points";
    case Type::table:
      return fmt::format("\"{}\"", class_name(key.table()));
    case Type::tables:
      return fmt::format("Sequence[\"{}\"]", class_name(key.table()));
  }
  return {};
}

std::string entry(const Shape& shape, const Key& key) {
  const bool chooses = shape.variant != Table::none && &key == &shape.table->keys[shape.table->chooser];
  std::string type;
  for (const Type each : key.types) type += fmt::format("{}{}", type.empty() ? "" : ", ", type_of(key, each));
  if (chooses) type = literal({shape.word()});
  const bool required = (key.required && key.unless.empty()) || (chooses && shape.variant > 0);
  // Union and Optional rather than `|`, which texts that name later types do not have.
  if (key.types.size() > 1) type = fmt::format("Union[{}]", type);
  type = required ? fmt::format("Required[{}]", type) : fmt::format("Optional[{}]", type);
  return fmt::format("        \"{}\": {},  # {}{}\n", key.name, type, key.meaning,
                     key.unit.empty() ? "" : fmt::format(" [{}]", key.unit));
}

std::string typed_dict(const Shape& shape) {
  const std::string name = class_name(shape);
  std::string text = fmt::format("{} = TypedDict(\n    \"{}\",\n    {{\n", name, name);
  for (const Key* key : shape.keys()) text += entry(shape, *key);
  return text + "    },\n    total=False,\n)\n";
}

}  // namespace

std::string python_types(const Table& table) {
  std::string text =
      "\"\"\"Types of the tables that make_scene takes. Written by `muslin schema --python`; do not "
      "edit.\"\"\"\n\n"
      "# ruff: noqa: E501, UP007, UP013, UP045\n"
      "import os\n"
      "import sys\n"
      "from collections.abc import Sequence\n"
      "from typing import Any, Literal, Optional, TypedDict, Union\n\n"
      "import numpy as np\nimport numpy.typing as npt\n\n"
      "from muslin._muslin import Mesh\n\n"
      "if sys.version_info >= (3, 11):\n"
      "    from typing import Required\n"
      "else:  # which type checkers alone know\n"
      "    Required = Optional\n\n"
      "Vector = Union[Sequence[float], npt.NDArray[np.floating[Any]]]\n"
      "Points = Union[Sequence[Vector], npt.NDArray[np.floating[Any]]]\n"
      "Path = Union[str, os.PathLike[str], Mesh]\n";
  const std::vector<const Table*> tables = tables_in(table);
  for (auto at = tables.rbegin(); at != tables.rend(); ++at) {
    const std::vector<Shape> shapes = shapes_of(**at);
    std::string names;
    for (const Shape& shape : shapes) {
      text += fmt::format("\n{}", typed_dict(shape));
      names += fmt::format("{}{}", names.empty() ? "" : ", ", class_name(shape));
    }
    if (shapes.size() > 1) text += fmt::format("\n{} = Union[{}]\n", class_name(**at), names);
  }
  return text;
}

}  // namespace muslin::schema
