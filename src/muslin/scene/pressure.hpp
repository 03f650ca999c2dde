// A pressure acts inside a shell that is closed or nearly closed: constant, over time, or that of a fixed
// amount of gas. docs/theory/pressure.md.
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
  KeyedNumber pressure;  ///< excess over the outside [Pa]; of a gas: where it fills the volume at rest
  bool gas = false;      ///< a fixed amount of gas at a constant temperature, in place of a fixed pressure
  double atmosphere = 101325;                                        ///< outside, for a gas [Pa]
  double from = 0, until = std::numeric_limits<double>::infinity();  ///< [s]
  Place place;
};

/// [[pressure]] of a scene file.
const schema::Table& pressure_table();
void finish_pressure(const TomlTable& table, std::size_t index, PressureSettings& pressure,
                     const Scene& scene);

/// Adds the pressures of the scene to the model. Errors: input, for a body whose vertices are not those of
/// its mesh, a surface that has no inside, or a gas without room.
void build_pressures(Model& model);

}  // namespace muslin
