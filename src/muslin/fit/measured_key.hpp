// Declares keys whose values are measured numbers: one, a list of repeats, or a number with its uncertainty.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "muslin/fit/measurements.hpp"
#include "muslin/schema/declare.hpp"

namespace muslin {

/// Returns the value of the key, which must be present, times `scale`. A list gives the mean and its standard
/// error; { value, deviation, count } gives deviation/√count. Errors: input.
Measured read_measured(const schema::Key& key, const TomlTable& table, double scale);

/// A key in a unit that is `scale` SI units.
template <class S>
schema::Declaration measured(std::string name, std::optional<Measured> S::* member, double scale = 1) {
  schema::Declaration key = schema::custom<S>(
      std::move(name), {schema::Type::number},
      [=](const schema::Key& k, const TomlTable& table, S& s) { s.*member = read_measured(k, table, scale); },
      [=](const schema::Key& k, const S& s, TomlValue& out) {
        if (s.*member) schema::append(out, k.name, schema::real((s.*member)->value / scale));
      });
  return key;
}

}  // namespace muslin
