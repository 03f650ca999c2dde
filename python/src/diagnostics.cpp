#include "diagnostics.hpp"

#include "arrays.hpp"
#include <fmt/format.h>
#include <nanobind/stl/string.h>

namespace muslin::python {
namespace {

template <class Number>
Array<Number, -1> column(const std::vector<Diagnostics>& rows, Number Diagnostics::* value) {
  std::vector<Number> numbers;
  numbers.reserve(rows.size());
  for (const Diagnostics& row : rows) numbers.push_back(row.*value);
  return taken(std::move(numbers));
}

using RowState = nb::typed<nb::dict, nb::str, nb::object>;

/// Takes the numbers of a row by their names.
struct RowWriter {
  nb::dict& state;
  template <class Number>
  void operator()(const char* name, const Number& number) {
    state[name] = number;
  }
  void operator()(const char* name, const Vec3& vector) {
    state[name] = nb::make_tuple(vector.x(), vector.y(), vector.z());
  }
};

/// Puts them into a row. Errors: KeyError, if the state of another version lacks one.
struct RowReader {
  const nb::dict& state;
  template <class Number>
  void operator()(const char* name, Number& number) {
    number = nb::cast<Number>(state[name]);
  }
  void operator()(const char* name, Vec3& vector) {
    for (int axis = 0; axis < 3; ++axis) vector[axis] = nb::cast<double>(state[name][axis]);
  }
};

template <class Row, class Numbers>
void each_number(Row& row, Numbers numbers) {
  Diagnostics::name_arrays(row, numbers);
  numbers("diagnostics.wall_ms", row.wall_ms);
}

}  // namespace

Columns columns_of(const std::vector<Diagnostics>& rows) {
  std::vector<Vec3> momenta;
  for (const Diagnostics& row : rows) momenta.push_back(row.momentum);
  Columns columns = nb::steal<Columns>(PyDict_New());
  columns["frame"] = column(rows, &Diagnostics::frame);
  columns["time"] = column(rows, &Diagnostics::time);
  columns["kinetic"] = column(rows, &Diagnostics::kinetic);
  columns["elastic"] = column(rows, &Diagnostics::elastic);
  columns["potential"] = column(rows, &Diagnostics::potential);
  columns["work"] = column(rows, &Diagnostics::work);
  columns["dissipated"] = column(rows, &Diagnostics::dissipated);
  columns["momentum"] = taken(std::move(momenta));
  columns["newton_iterations"] = column(rows, &Diagnostics::newton_iterations);
  columns["linear_iterations"] = column(rows, &Diagnostics::linear_iterations);
  columns["residual"] = column(rows, &Diagnostics::residual);
  columns["max_stretch"] = column(rows, &Diagnostics::max_stretch);
  columns["min_distance"] = column(rows, &Diagnostics::min_distance);
  columns["wall_ms"] = column(rows, &Diagnostics::wall_ms);
  columns["steps"] = column(rows, &Diagnostics::steps);
  columns["converged_steps"] = column(rows, &Diagnostics::converged_steps);
  columns["error"] = column(rows, &Diagnostics::error);
  columns["unbalanced"] = column(rows, &Diagnostics::unbalanced);
  columns["crossings"] = column(rows, &Diagnostics::crossings);
  columns["held_back"] = column(rows, &Diagnostics::held_back);
  columns["penetration"] = column(rows, &Diagnostics::penetration);
  columns["behind"] = column(rows, &Diagnostics::behind);
  return columns;
}

void bind_diagnostics(nb::module_& m) {
  nb::class_<Diagnostics>(m, "Diagnostics", "Diagnostics of a frame, over all bodies.")
      .def_ro("frame", &Diagnostics::frame)
      .def_ro("time", &Diagnostics::time, "[s]")
      .def_ro("kinetic", &Diagnostics::kinetic, "[J]")
      .def_ro("elastic", &Diagnostics::elastic, "Stored in the material [J].")
      .def_ro("potential", &Diagnostics::potential, "Stored in fields such as gravity [J].")
      .def_ro("work", &Diagnostics::work, "External work since the start [J].")
      .def_ro("material_work", &Diagnostics::material_work,
              "Share of `work` that changes of the material's numbers did [J].")
      .def_ro("dissipated", &Diagnostics::dissipated, "Lost since the start [J].")
      .def_ro("unbalanced", &Diagnostics::unbalanced,
              "Work of the solver's residuals since the start [J]: the balance has changed by this amount.")
      .def_prop_ro("balance", &Diagnostics::balance,
                   "kinetic + elastic + potential - work + dissipated [J]: constant.")
      .def_prop_ro(
          "momentum", [](const Diagnostics& row) { return to_array(row.momentum); }, nb::rv_policy::automatic,
          "(3,) [kg·m/s]")
      .def_ro("newton_iterations", &Diagnostics::newton_iterations, "Of this frame.")
      .def_ro("linear_iterations", &Diagnostics::linear_iterations, "Of this frame.")
      .def_ro("residual", &Diagnostics::residual, "Largest of this frame [m/s²].")
      .def_ro("max_stretch", &Diagnostics::max_stretch, "Largest length over rest length.")
      .def_ro(
          "min_distance", &Diagnostics::min_distance,
          "Smallest gap in contact [m]; infinity without contact, not above 0 while a tangled start has not "
          "parted.")
      .def_ro("held_back", &Diagnostics::held_back,
              "Vertices moved along keyframes that an obstacle holds back.")
      .def_ro("behind", &Diagnostics::behind, "Largest distance of such a vertex from its path [m].")
      .def_ro("steps", &Diagnostics::steps, "Of this frame.")
      .def_ro("converged_steps", &Diagnostics::converged_steps,
              "Steps of this frame that ended within their tolerance.")
      .def_ro("error", &Diagnostics::error,
              "Largest estimated error of a step of this frame, as a displacement [m].")
      .def_ro("crossings", &Diagnostics::crossings,
              "Pairs of triangles that still cross after a tangled start.")
      .def_ro("penetration", &Diagnostics::penetration,
              "Largest depth of a crossing or inside a collider [m].")
      .def_ro("wall_ms", &Diagnostics::wall_ms, "Time that this frame took.")
      .def("__getstate__",
           [](const Diagnostics& row) {
             RowState state;
             each_number(row, RowWriter{state});
             return state;
           })
      .def("__setstate__",
           [](Diagnostics& row, const RowState& state) {
             new (&row) Diagnostics();
             each_number(row, RowReader{state});
           })
      .def("__repr__", [](const Diagnostics& row) {
        return fmt::format(
            "<muslin.Diagnostics frame {}: kinetic {:.6g}, elastic {:.6g}, potential {:.6g} J>", row.frame,
            row.kinetic, row.elastic, row.potential);
      });
}

}  // namespace muslin::python
