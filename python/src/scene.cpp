// Scenes: read from files, parsed from text.
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "json.hpp"
#include "paths.hpp"
#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "muslin/hosts.hpp"
#include "muslin/scene/names.hpp"

namespace nb = nanobind;
using namespace nb::literals;

namespace muslin::python {
namespace {

using Meshes = std::map<std::string, std::shared_ptr<const Mesh>>;

Scene with_meshes(Scene scene, const Meshes& meshes) {
  for (const auto& [path, mesh] : meshes) {
    if (!mesh) throw Error(ErrorKind::usage, "meshes[" + path + "] is None", "give a muslin.Mesh");
    scene.meshes[path] = std::make_shared<const Mesh>(*mesh);
  }
  return scene;
}

using State = std::tuple<std::string, std::string, std::vector<std::string>, std::map<std::string, Mesh>>;

State state_of(const Scene& scene) {
  std::map<std::string, Mesh> meshes;
  for (const auto& [path, mesh] : scene.meshes) meshes.emplace(path, *mesh);
  return {scene.text, scene.file.string(), scene.overrides, std::move(meshes)};
}

void set_state(Scene& scene, const State& state) {
  const auto& [text, file, overrides, meshes] = state;
  new (&scene) Scene(parse_scene(text, file, overrides));
  for (const auto& [path, mesh] : meshes) scene.meshes[path] = std::make_shared<const Mesh>(mesh);
}

}  // namespace

JsonObject from_json(const std::string& text) {
  return JsonObject(nb::module_::import_("json").attr("loads")(text));
}

void bind_scene(nb::module_& m) {
  nb::class_<Scene>(m, "Scene", "The settings of a scene, checked and with defaults filled in.")
      .def_ro("title", &Scene::title)
      .def_ro("file", &Scene::file, "Where it was read from; its paths are relative to that.")
      .def_ro("text", &Scene::text, "The file as it was read.")
      .def_ro("overrides", &Scene::overrides, "\"KEY=VALUE\" that replaced settings of the text.")
      .def("__getstate__", &state_of)
      .def("__setstate__", &set_state)
      .def_prop_ro(
          "resolved", [](const Scene& s) { return from_json(s.resolved); },
          "Every setting with its value, defaults included, by the words of the scene file.")
      .def_ro("warnings", &Scene::warnings, "Settings that are legal but probably not intended.")
      .def_prop_ro(
          "duration", [](const Scene& s) { return s.time.duration; }, "[s]")
      .def_prop_ro(
          "frame_rate", [](const Scene& s) { return s.time.frame_rate; }, "[1/s]")
      .def_prop_ro(
          "steps_per_frame", [](const Scene& s) { return s.time.steps_per_frame; },
          "None: chosen by the program as the motion needs them.")
      .def_prop_ro(
          "effort", [](const Scene& s) { return name_of(effort_names(), s.solver.effort); },
          "How accurately steps are solved: \"draft\", \"normal\" or \"exact\".")
      .def_prop_ro(
          "tolerance", [](const Scene& s) { return s.solver.error_tolerance(); },
          "Largest error of a step, as a share of the motion that the accelerations at work cause in it.")
      .def_prop_ro(
          "frames", [](const Scene& s) { return s.time.frames(); }, "The last frame; frame 0 is the start.")
      .def_prop_ro(
          "time_step", [](const Scene& s) { return s.time.step(); },
          "Of a fixed number of steps a frame; the longest one otherwise [s].")
      .def("__repr__", [](const Scene& s) {
        return fmt::format("<muslin.Scene \"{}\": {} bodies, {} frames>", s.title, s.bodies.size(),
                           s.time.frames());
      });

  m.def(
      "read_scene",
      [](const FilePath& file, const std::vector<std::string>& overrides, const Meshes& meshes) {
        return with_meshes(read_scene(file, overrides), meshes);
      },
      "file"_a, "overrides"_a = std::vector<std::string>(), nb::kw_only(), "meshes"_a = Meshes(),
      "Reads and checks a scene file. overrides: \"KEY=VALUE\" as `muslin run --set` takes them. meshes: "
      "used in\n"
      "place of the files of these paths.");
  m.def(
      "parse_scene",
      [](const std::string& text, const FilePath& file, const std::vector<std::string>& overrides,
         const Meshes& meshes) { return with_meshes(parse_scene(text, file, overrides), meshes); },
      "text"_a, "file"_a = FilePath{"scene.toml"}, "overrides"_a = std::vector<std::string>(), nb::kw_only(),
      "meshes"_a = Meshes(),
      "The same for a text; `file` is the name that messages carry and what paths are relative to.");
}

}  // namespace muslin::python
