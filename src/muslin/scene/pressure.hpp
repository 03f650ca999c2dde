// PressureSettings describes a pressure inside a closed or nearly closed shell: constant, keyframed, or that
// of a fixed amount of gas. docs/theory/pressure.md.
#pragma once

#include <cstddef>
#include <limits>
#include <string>

#include "muslin/api.hpp"
#include "muslin/core/error.hpp"
#include "muslin/force/keyed.hpp"

namespace muslin {

struct Model;
class TomlTable;
struct Scene;
namespace schema {
struct Table;
}

struct MUSLIN_API PressureSettings {
  std::string name, body;
  KeyedNumber pressure;        ///< excess over the outside [Pa]; of a gas: at the rest volume
  bool gas = false;            ///< a fixed amount of gas at constant temperature, not a given pressure
  double atmosphere = 101325;  ///< outside, for a gas [Pa]
  double from = 0, until = std::numeric_limits<double>::infinity();  ///< [s]
  Place place;
};

/// [[pressure]] of a scene file.
const schema::Table& pressure_table();
void finish_pressure(const TomlTable& table, std::size_t index, PressureSettings& pressure,
                     const Scene& scene);

/// Adds the pressures of the scene to the model. Errors: input, for a body whose vertices are not those of
/// its mesh, a surface that has no inside, or a gas without volume.
void build_pressures(Model& model);

}  // namespace muslin
