// muslin check FILE
#include <cstdio>
#include <filesystem>
#include <memory>

#include "command.hpp"
#include <fmt/format.h>

#include "muslin/hosts.hpp"

namespace muslin::app {

void add_check(CLI::App& program) {
  struct Arguments {
    std::string file, picture;
    bool json = false;
    std::vector<std::string> set;
  };
  auto* command = program.add_subcommand("check", "report errors of a scene or mesh, and what will be built");
  auto a = std::make_shared<Arguments>();
  command->add_option("FILE", a->file, "scene (.toml) or mesh file")->required();
  command->add_flag("--json", a->json, "print JSON");
  command->add_option("--picture", a->picture,
                      "write FILE.png of the start of a scene with crossings marked, and of its maps");
  command->add_option("--set", a->set, "KEY=VALUE overrides a setting of the scene")->allow_extra_args(false);
  command->callback([a] {
    listen_for_interrupts();
    if (std::filesystem::path(a->file).extension() == ".toml") {
      const Model model = build_model(read_scene(a->file, a->set), {{}, [] { return interrupted(); }});
      const std::vector<Crossing> crossings =
          model.contact
              ? one_of_each_pair(*model.contact, find_crossings(*model.contact, model.rest_positions))
              : std::vector<Crossing>();
      print(a->json ? describe_json(model, crossings) : describe_text(model, crossings));
      if (!a->picture.empty()) write_png(a->picture, draw_start(model, crossings));
      if (crossings.empty()) return;
      const std::string problem = fmt::format("surfaces cross at the start in {} places: {}",
                                              crossings.size(), describe_bodies(*model.contact, crossings));
      const std::string where = a->picture.empty() ? "; --picture FILE.png shows where" : "";
      const TangledStart tangled = model.scene.contact.tangled;
      if (tangled == TangledStart::refuse) {
        throw Error(ErrorKind::input, {a->file}, problem,
                    advice(*model.contact, model.rest_positions, crossings) + where);
      }
      const char* then = tangled == TangledStart::repair ? "pulls them apart before its first frame"
                                                         : "leaves them free of each other until they part";
      std::fprintf(stderr, "muslin: warning: %s: %s; the run %s%s\n", a->file.c_str(), problem.c_str(), then,
                   where.c_str());
      return;
    }
    if (!a->picture.empty())
      throw Error(ErrorKind::usage, "--picture is for scenes", "name a .toml file, or omit it");
    const MeshFile file = read_mesh(a->file);
    require_usable(file.mesh, a->file);
    MeshReport report = inspect(file.mesh);
    if (!file.note.empty()) report.warnings.push_back(file.note);
    print(a->json ? describe_json(report, a->file) : describe_text(report, a->file));
  });
}

}  // namespace muslin::app
