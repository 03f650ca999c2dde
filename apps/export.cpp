// muslin export RUN FILE
#include <cstdio>
#include <filesystem>
#include <memory>

#include "command.hpp"
#include "progress_line.hpp"
#include <fmt/format.h>

#include "muslin/hosts.hpp"

namespace muslin::app {

void add_export(CLI::App& program) {
  struct Arguments {
    std::string run, file, body, surface = "skin", carry;
    int smooth = 0, subdivide = 0;
    double thickness = 0;
    bool quiet = false;
  };
  auto* command = program.add_subcommand("export", "write a run for other programs");
  auto a = std::make_shared<Arguments>();
  command->add_option("RUN", a->run, "run directory")->required();
  command
      ->add_option("FILE", a->file,
                   "FILE.pc2, .mdd, .obj, .ply, .usda, .glb, .gltf or .vtu; the suffix selects the format")
      ->required();
  command->add_option("--body", a->body, "body to export (default: the only one; .usda: all)");
  command->add_option("--surface", a->surface, "skin (default) or contour")
      ->check(CLI::IsMember({"skin", "contour"}));
  command->add_option("--smooth", a->smooth,
                      "rounds of smoothing that does not shrink the surface, 0 to 1000");
  command->add_option("--subdivide", a->subdivide,
                      "levels of subdivision, 0 to 8: Loop's on triangles, else Catmull and Clark's");
  command->add_option("--carry", a->carry,
                      "finer mesh that takes the surface's place, modelled where the body's mesh is");
  command->add_option("--thickness", a->thickness, "thickness in metres of the solid made of the surface");
  command->add_flag("--quiet", a->quiet, "no progress");
  command->callback([a] {
    listen_for_interrupts();
    ProgressLine line(a->quiet);
    ExportOptions options;
    options.body = a->body;
    options.surface = a->surface == "contour" ? SurfaceKind::contour : SurfaceKind::skin;
    options.smooth = a->smooth;
    options.subdivide = a->subdivide;
    options.carry = a->carry;
    options.thickness = a->thickness;
    const RunReader run(a->run);
    const std::filesystem::path file(a->file);
    if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
    const ExportReport report = export_run(run, file, options, line.progress());
    if (report.frames_drawn_in > 0)
      print(fmt::format("the carried mesh was drawn in, so that it does not cross, in {} of {} frames\n",
                        report.frames_drawn_in, run.frame_count()));
    if (report.frames_crossing > 0)
      std::fprintf(
          stderr,
          "muslin: warning: the carried mesh crosses itself or another body in %d frames, most in frame "
          "%d: %zu pairs of triangles; carry a mesh with smaller offsets, or simulate a finer one\n",
          report.frames_crossing, report.frame_of_most, report.most_crossings);
  });
}

}  // namespace muslin::app
