// PressureSettings describes a pressure inside a closed or nearly closed shell: constant, keyframed, or that
// of a fixed amount of gas. docs/theory/pressure.md.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <string>

#include "muslin/api.hpp"
#include "muslin/core/error.hpp"
#include "muslin/force/keyed.hpp"
#include "muslin/schema/variation.hpp"

namespace muslin {

class Component;
struct Model;
class TomlTable;
struct Scene;
namespace schema {
struct Table;
}

struct MUSLIN_API PressureSettings {
  std::string name, body;
  KeyedNumber pressure;           ///< excess over the outside [Pa]; of a gas: at the rest volume
  double weight = 1;              ///< of the pressure at a vertex
  schema::Variations variations;  ///< of `weight`, by a map
  bool gas = false;               ///< a fixed amount of gas at constant temperature, not a given pressure
  double atmosphere = 101325;     ///< outside, for a gas [Pa]
  double from = 0, until = std::numeric_limits<double>::infinity();  ///< [s]
  Place place;
};

/// [[pressure]] of a scene file.
const schema::Table& pressure_table();
void finish_pressure(const TomlTable& table, std::size_t index, PressureSettings& pressure,
                     const Scene& scene);

/// Adds the pressures of the scene to the model, and their maps to its components. Errors: input, for a body
/// whose vertices are not those of its mesh, a surface that has no inside, a gas without volume, or a wrong
/// map.
void build_pressures(Model& model, std::span<const std::shared_ptr<Component>> components);

}  // namespace muslin
