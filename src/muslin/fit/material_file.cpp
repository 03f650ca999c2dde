#include "muslin/fit/material_file.hpp"

#include <fmt/format.h>

#include "muslin/material/shell_material.hpp"
#include "muslin/schema/table.hpp"

namespace muslin {
namespace {

std::string toml_text(const std::string& text) {
  std::string quoted;
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
  }
  return fmt::format("\"{}\"", quoted);
}

std::string value_text(const FittedValue& value) {
  if (!value.curve) return written_number(value.value);
  std::string points;
  for (const Vec2& point : *value.curve)
    points += fmt::format("{}[{}, {}]", points.empty() ? "" : ", ", written_number(point[0]),
                          written_number(point[1]));
  return "[" + points + "]";
}

/// The unit, the uncertainty, the origin, the residual.
std::string remark(const FittedValue& value) {
  const schema::Key* key = shell_material_table().find(value.key);
  std::string text = key->unit;
  const auto join = [&](const std::string& more) { text += (text.empty() ? "" : "; ") + more; };
  if (value.plus_minus)
    join(value.curve ? fmt::format("± {:.2g} % of the forces", 100 * *value.plus_minus)
                     : fmt::format("± {:.2g}", *value.plus_minus));
  join((value.guess ? "guess: " : "") + value.from);
  if (value.residual) join(fmt::format("residual {:.2g} %", 100 * *value.residual));
  return text;
}

std::string source_text(const MaterialFile& file) {
  std::string text = fmt::format("muslin fit from {}", file.measurements);
  if (!file.source.empty()) text += ": " + file.source;
  for (const FittedValue& value : file.values)
    text += fmt::format("; {}: {}{}", value.key, value.guess ? "guess, " : "", value.from);
  return text;
}

/// Those of the list, and the bias unless it was measured.
std::string guesses_text(const std::vector<FittedValue>& values) {
  std::string text;
  bool bias = false;
  const auto append = [&](const std::string& key) {
    text += fmt::format("{}\"shell.{}\"", text.empty() ? "" : ", ", key);
  };
  for (const FittedValue& value : values) {
    bias = bias || value.key == "bending_bias";
    if (value.guess) append(value.key);
  }
  if (!bias) append("bending_bias");
  return text;
}

}  // namespace

std::string material_text(const MaterialFile& file) {
  std::string text;
  for (const std::string& warning : file.warnings) text += fmt::format("# warning: {}\n", warning);
  text += fmt::format("name = {}\ndescription = {}\nsource = {}\nguesses = [{}]\n\n[shell]\n",
                      toml_text(file.name), toml_text(file.description), toml_text(source_text(file)),
                      guesses_text(file.values));
  for (const FittedValue& value : file.values)
    text += fmt::format("{} = {}  # {}\n", value.key, value_text(value), remark(value));
  std::string reference;
  for (const auto& [key, number] : file.reference) reference += fmt::format("{} = {:.6g}\n", key, number);
  for (const FittedValue& value : file.values) {
    if (value.plus_minus) reference += fmt::format("plus_minus_{} = {:.3g}\n", value.key, *value.plus_minus);
    if (value.residual) reference += fmt::format("residual_{} = {:.3g}\n", value.key, *value.residual);
  }
  return reference.empty() ? text : text + "\n[reference]\n" + reference;
}

}  // namespace muslin
