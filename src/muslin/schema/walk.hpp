// Visits a table and all tables in it.
#pragma once

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <string>
#include <vector>

#include "muslin/schema/table.hpp"

namespace muslin::schema {

/// The keys of a table for one of its variants; all keys of a table without variants.
struct Shape {
  const Table* table = nullptr;
  std::size_t variant = Table::none;

  std::vector<const Key*> keys() const { return table->keys_of(variant); }
  /// Returns the word of the variant; empty without variants.
  std::string word() const { return variant == Table::none ? "" : table->variants[variant].word; }
};

inline std::vector<Shape> shapes_of(const Table& table) {
  if (table.variants.empty()) return {{&table, Table::none}};
  std::vector<Shape> shapes;
  for (std::size_t v = 0; v < table.variants.size(); ++v) shapes.push_back({&table, v});
  return shapes;
}

/// Returns the table and all tables in it, each once, every table before those in it.
inline std::vector<const Table*> tables_in(const Table& root) {
  std::vector<const Table*> tables = {&root};
  for (std::size_t i = 0; i < tables.size(); ++i) {
    for (const Shape& shape : shapes_of(*tables[i])) {
      for (const Key* key : shape.keys()) {
        const Table* inner = key->table == nullptr ? nullptr : &key->table();
        if (inner != nullptr && std::find(tables.begin(), tables.end(), inner) == tables.end())
          tables.push_back(inner);
      }
    }
  }
  return tables;
}

/// Returns the table's name with its letters, digits and dots only: "[[body]]" → "body", "`material` of a
/// shell" → "material_of_a_shell".
inline std::string plain_name(const Table& table) {
  std::string name;
  for (const char c : table.name) {
    if (c == ' ') name += '_';
    if (std::isalnum(static_cast<unsigned char>(c)) || c == '.') name += c;
  }
  return name;
}

}  // namespace muslin::schema
