// Publishes a table and all tables in it: for editors, for the guide, and for Python.
#pragma once

#include <string>

#include "muslin/schema/table.hpp"

namespace muslin::schema {

/// Returns a JSON Schema (draft 2020-12) with descriptions, units, ranges, defaults and choices. Each variant
/// of a table is a separate object, so that keys of other variants are refused.
std::string json_schema(const Table& table, const std::string& title);

/// Returns a Markdown table of the keys of each table, between the lines `<!-- schema: NAME -->` and `<!--
/// end -->`. Range limits that no real scene reaches are left out.
std::string markdown(const Table& table);

/// Returns the source of a Python module with a TypedDict for each table, and for each variant.
std::string python_types(const Table& table);

}  // namespace muslin::schema
