// Reads, writes and checks the table that may stand in place of a number (schema/variation.hpp).
#pragma once

#include "muslin/core/toml_table.hpp"
#include "muslin/schema/subject.hpp"
#include "muslin/schema/variation.hpp"

namespace muslin::schema {

struct Key;
struct Table;

/// The table; its settings are a Variation.
const Table& variation_table();

/// Reads the table under a key, each of whose values must be in the key's range. Errors: input.
Variation read_variation(const Key& key, const TomlTable& table);
/// Throws Error(input) for what reading would refuse.
void check_variation(const Key& key, const Variation& variation, const Subject& subject);

}  // namespace muslin::schema
