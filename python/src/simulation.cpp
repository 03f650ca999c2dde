// Simulations: stepped, looked at, changed, saved.
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "bindings.hpp"
#include "callbacks.hpp"
#include "diagnostics.hpp"
#include "errors.hpp"
#include "simulation_object.hpp"
#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

namespace nb = nanobind;
using namespace nb::literals;

namespace muslin::python {
namespace {

using Self = SimulationObject;
using Force = nb::typed<nb::callable, nb::object(Array<double, -1, 3>, Array<double, -1, 3>, double)>;
using PointsByName = nb::typed<nb::dict, nb::str, Array<double, 3>>;

int traverse(PyObject* self, visitproc visit, void* arg) {
  Py_VISIT(Py_TYPE(self));
  if (!nb::inst_ready(self)) return 0;
  for (const nb::object& force : nb::inst_ptr<Self>(self)->forces()) Py_VISIT(force.ptr());
  return 0;
}

int clear(PyObject* self) {
  if (nb::inst_ready(self)) nb::inst_ptr<Self>(self)->forget_forces();
  return 0;
}

PyType_Slot slots[] = {{Py_tp_traverse, reinterpret_cast<void*>(traverse)},
                       {Py_tp_clear, reinterpret_cast<void*>(clear)},
                       {0, nullptr}};

Array<double, -1, 3> carried(const Self& self, const std::optional<std::string>& name,
                             const std::string& surface, const std::vector<Vec3>& vectors) {
  const Component& body = find_body(*self.model(), name);
  const Embedding* embedding = &body.skin;
  if (choice(surface, {"skin", "contour"}, "surface") == 1) {
    const std::vector<CachedPoints> cached = body.cached_points();
    const auto contour = std::find_if(cached.begin(), cached.end(),
                                      [](const CachedPoints& each) { return each.name == "contour"; });
    if (contour == cached.end())
      throw Error(ErrorKind::usage, "the body \"" + body.name + "\" is no lattice and has no contour",
                  "take its skin");
    embedding = contour->embedding;
  }
  std::vector<Vec3> points(embedding->size());
  embedding->apply(self.model()->of(body, vectors), points);
  return taken(std::move(points));
}

PointsByName at_probes(const Self& self, const std::vector<Vec3>& vectors) {
  PointsByName points;
  for (const Probe& probe : self.model()->probes) {
    Vec3 point;
    probe.point.apply(self.model()->of(self.model()->bodies[static_cast<std::size_t>(probe.body)], vectors),
                      {&point, 1});
    points[probe.name.c_str()] = to_array(point);
  }
  return points;
}

nb::typed<nb::dict, nb::str, nb::float_> costs_of(const RunCosts& costs) {
  nb::typed<nb::dict, nb::str, nb::float_> seconds;
  seconds["search"] = costs.search;
  seconds["limit"] = costs.limit;
  seconds["contact"] = costs.contact;
  seconds["linearize"] = costs.linearize;
  seconds["solve"] = costs.solve;
  return seconds;
}

nb::bytes checkpoint(const Self& self) {
  const std::vector<std::uint8_t> bytes = self.simulation().checkpoint();
  return nb::bytes(bytes.data(), bytes.size());
}

/// Another simulation of the same model in the same state, without forces in Python.
void make_copy(Self& copy, const std::shared_ptr<const Model>& model, const SimulationOptions& options,
               const std::vector<std::uint8_t>& state) {
  new (&copy) Self(model, {options.allow_tangled, true});
  copy.restore(state);
}

nb::object copy_of(nb::handle_t<Self> handle) {
  const Self& self = *nb::inst_ptr<Self>(handle);
  nb::object copy = nb::inst_alloc(handle.type());
  make_copy(*nb::inst_ptr<Self>(copy), self.model(), self.simulation().options(),
            self.simulation().checkpoint());
  nb::inst_mark_ready(copy);
  return copy;
}

using State = std::tuple<Scene, bool, nb::bytes>;

State state_of(const Self& self) {
  if (self.is_cut())
    throw Error(ErrorKind::usage, "a simulation that was cut cannot be pickled",
                "make it from its scene, cut it again, and restore() its checkpoint()");
  return {self.model()->scene, self.simulation().options().allow_tangled, checkpoint(self)};
}

void set_state(Self& self, const State& state) {
  const auto& [scene, allow_tangled, bytes] = state;
  const auto* data = static_cast<const std::uint8_t*>(bytes.data());
  make_copy(self, std::make_shared<const Model>(build_model(scene)), {allow_tangled},
            {data, data + bytes.size()});
}

int next_frame(Self& self) {
  if (self.simulation().frame() >= self.model()->scene.time.frames()) throw nb::stop_iteration();
  self.advance(progress_of(std::nullopt, std::nullopt));
  return self.simulation().frame();
}

void bind_forces(nb::module_& m) {
  nb::class_<PinForce>(m, "PinForce", "The force that a pin exerts on its body.")
      .def_prop_ro(
          "sum", [](const PinForce& force) { return to_array(force.sum); }, nb::rv_policy::automatic,
          "On all of its vertices, (3,) [N].")
      .def_ro("mean", &PinForce::mean, "Magnitude on a vertex, mean over its vertices [N].")
      .def_ro("largest", &PinForce::largest, "Magnitude on a vertex, the largest [N].")
      .def_ro("most", &PinForce::most, "Magnitude of `sum`, the largest of all steps so far [N].");
  nb::class_<AttachmentForce>(m, "AttachmentForce",
                              "The force of the springs of an attachment on the points of its `body`.")
      .def_prop_ro(
          "sum", [](const AttachmentForce& force) { return to_array(force.sum); }, nb::rv_policy::automatic,
          "Of all joints, (3,) [N].")
      .def_ro("mean", &AttachmentForce::mean, "Magnitude of a joint that holds [N].")
      .def_ro("largest", &AttachmentForce::largest, "The largest magnitude of a joint [N].")
      .def_ro("holding", &AttachmentForce::holding, "Joints that hold; 0 before the first step.");
}

}  // namespace

void bind_simulation(nb::module_& m) {
  bind_diagnostics(m);
  bind_forces(m);
  nb::class_<Self>(
      m, "Simulation", nb::type_slots(slots),
      "A model and its state, advanced frame by frame:\n\n"
      "    for frame in simulation:\n"
      "        print(frame, simulation.positions.mean(axis=0))\n\n"
      "runs to the scene's last frame. The GIL is released while stepping; one thread at a time may use\n"
      "a simulation.")
      .def(
          "__init__",
          [](Self* self, std::shared_ptr<const Model> model, bool allow_tangled) {
            const nb::gil_scoped_release nogil;
            new (self) Self(std::move(model), {allow_tangled});
          },
          "model"_a, nb::kw_only(), "allow_tangled"_a = false,
          "allow_tangled: start although surfaces cross; these are left free of each other until they part.")
      .def(
          "__init__",
          [](Self* self, const Scene& scene, bool allow_tangled, const Report& progress,
             const Cancel& cancel) {
            const nb::gil_scoped_release nogil;
            new (self) Self(std::make_shared<const Model>(build_model(scene, progress_of(progress, cancel))),
                            {allow_tangled});
          },
          "scene"_a, nb::kw_only(), "allow_tangled"_a = false, "progress"_a = nb::none(),
          "cancel"_a = nb::none(), "Builds the scene's model first.")
      .def_prop_ro("model", [](const Self& self) { return self.model(); })
      .def_prop_ro(
          "frame", [](const Self& self) { return self.simulation().frame(); }, "The last finished frame.")
      .def_prop_ro(
          "steps_done", [](const Self& self) { return self.simulation().steps_done(); },
          "Steps of the frame in work; 0 between frames.")
      .def_prop_ro(
          "time", [](const Self& self) { return self.simulation().state().time; }, "[s]")
      .def_prop_ro(
          "diagnostics", [](const Self& self) { return self.simulation().diagnostics(); },
          "Of the last finished frame.")
      .def(
          "history", [](const Self& self) { return self.simulation(), columns_of(self.history()); },
          "Diagnostics of all frames so far, or since restore(): an array per column.")
      .def_prop_rw(
          "positions", [](Self& self) { return self.positions(); },
          [](Self& self, const ArrayLike& positions) { self.set_positions(positions); },
          nb::for_getter(nb::sig("def positions(self) -> numpy.typing.NDArray[numpy.float64]")),
          nb::for_setter(nb::sig("def positions(self, positions: numpy.typing.ArrayLike, /) -> None")),
          "(V, 3) of all bodies, one after the other [m]. Reading gives a read-only array of this moment,\n"
          "which later steps do not change. Setting moves the vertices as by hand: pins that hold take hold\n"
          "where their vertices are put, and the change of energy counts as work.")
      .def_prop_rw(
          "velocities", [](Self& self) { return self.velocities(); },
          [](Self& self, const ArrayLike& velocities) { self.set_velocities(velocities); },
          nb::for_getter(nb::sig("def velocities(self) -> numpy.typing.NDArray[numpy.float64]")),
          nb::for_setter(nb::sig("def velocities(self, velocities: numpy.typing.ArrayLike, /) -> None")),
          "(V, 3) [m/s], read and set as positions are.")
      .def(
          "advance",
          [](Self& self, const Report& progress, const Cancel& cancel) {
            self.advance(progress_of(progress, cancel));
          },
          nb::kw_only(), "progress"_a = nb::none(), "cancel"_a = nb::none(),
          "Advances to the end of the next frame. progress(fraction, stage) and cancel() are called before "
          "each step.\n"
          "After Interrupted, KeyboardInterrupt, or an exception of a callback the next call continues from "
          "the "
          "last\n"
          "complete step.")
      .def("step", &Self::step, "Makes one time step; the last one of a frame finishes the frame.")
      .def(
          "cut",
          [](Self& self, const std::vector<std::array<int, 2>>& edges,
             const std::optional<std::string>& body) {
            self.cut(find_body(*self.model(), body).name, edges);
          },
          "edges"_a, nb::kw_only(), "body"_a = nb::none(),
          "Cuts a shell open along edges, given as pairs of vertices of its mesh counted from 0, and "
          "continues "
          "with\n"
          "the changed shell. Faces that no other edge joins are separated; new vertices come last. Vertices "
          "keep\n"
          "their motion, the change of energy counts as work, and `model` is a new model. Forces in Python "
          "are\n"
          "dropped: add them again.")
      .def(
          "add_force",
          [](Self& self, const Force& force, const std::string& name,
             const std::optional<std::string>& body) { self.add_force(nb::object(force), name, body); },
          "force"_a, nb::kw_only(), "name"_a = "force", "body"_a = nb::none(),
          "force(x, v, t) returns the force on each vertex, (V, 3) [N], or None for nothing: x and v, (V, 3) "
          "[m] and\n"
          "[m/s], and t [s] are those at the beginning of each step, and the force is constant during it. So "
          "it\n"
          "is explicit: a force that is stiff relative to the step is unstable; a drag -c v needs steps "
          "below "
          "2 m/c.\n"
          "With `body` it receives and acts on the vertices of that body only. Forces are not part of "
          "checkpoints:\n"
          "add them again before restore().")
      .def(
          "points",
          [](const Self& self, const std::optional<std::string>& body, const std::string& surface) {
            return carried(self, body, surface, self.simulation().state().positions);
          },
          "body"_a = nb::none(), nb::kw_only(), "surface"_a = "skin",
          "The current positions of the vertices of a body's mesh (\"skin\") or \"contour\", (n, 3) [m].")
      .def(
          "probes", [](const Self& self) { return at_probes(self, self.simulation().state().positions); },
          "The position of each probe, (3,) [m].")
      .def(
          "probe_velocities",
          [](const Self& self) { return at_probes(self, self.simulation().state().velocities); },
          "The velocity of each probe, (3,) [m/s].")
      .def(
          "pin_force",
          [](const Self& self, const std::string& pin) { return self.simulation().pin_force(pin); }, "pin"_a,
          "The force of a pin in the last step.")
      .def(
          "attachment_force",
          [](const Self& self, const std::string& name) { return self.simulation().attachment_force(name); },
          "attachment"_a, "The force of an attachment after the last step.")
      .def(
          "costs", [](const Self& self) { return costs_of(self.simulation().costs()); },
          "Where the time of contact went since the simulation was made: seconds of \"search\", \"limit\", "
          "\"contact\", "
          "\"linearize\" and\n"
          "\"solve\".")
      .def("__getstate__", &state_of)
      .def("__setstate__", &set_state)
      .def("__copy__", &copy_of, nb::sig("def __copy__(self) -> Simulation"),
           "Another simulation of the same model and state, without forces in Python.")
      .def(
          "__deepcopy__", [](nb::handle_t<Self> self, const nb::dict&) { return copy_of(self); }, "memo"_a,
          nb::sig("def __deepcopy__(self, memo: dict[int, object]) -> Simulation"))
      .def("checkpoint", &checkpoint, "The complete state: going on from it gives the same bits.")
      .def(
          "restore",
          [](Self& self, const nb::bytes& bytes) {
            const auto* data = static_cast<const std::uint8_t*>(bytes.data());
            self.restore({data, data + bytes.size()});
          },
          "checkpoint"_a,
          "Goes back to a checkpoint of the same bodies; pins, loads, times and solver settings may have "
          "changed.")
      .def(
          "__iter__", [](nb::typed<nb::handle, Self> self) { return nb::borrow(self); },
          nb::sig("def __iter__(self) -> Simulation"))
      .def("__next__", &next_frame, "Advances, and returns the frame.")
      .def("__repr__", [](const Self& self) {
        return fmt::format("<muslin.Simulation \"{}\" at frame {} of {}>", self.model()->scene.title,
                           self.simulation().frame(), self.model()->scene.time.frames());
      });
}

}  // namespace muslin::python
