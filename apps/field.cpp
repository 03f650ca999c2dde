// muslin field MESH --voxel-width W
#include <memory>

#include "command.hpp"

#include "muslin/hosts.hpp"

namespace muslin::app {

void add_field(CLI::App& program) {
  struct Arguments {
    std::string mesh, slice, margin;
    double voxel_width = 0;
    double thickness = -1;
    bool csv = false;
  };
  auto* command = program.add_subcommand("field", "print a slice of a mesh's distance field");
  auto arguments = std::make_shared<Arguments>();
  command->add_option("MESH", arguments->mesh, "mesh file")->required();
  command->add_option("--voxel-width", arguments->voxel_width, "distance between samples [m]")
      ->required()
      ->check(positive_number());
  command->add_option("--slice", arguments->slice,
                      "plane, e.g. z=0 (default: the middle, across the thinnest axis)");
  command->add_option("--margin", arguments->margin,
                      "rings of samples outside the mesh: N or X,Y,Z (default: 1)");
  command->add_option("--thickness", arguments->thickness, "of an open mesh [m] (default: one voxel width)")
      ->check(non_negative_number());
  command->add_flag("--csv", arguments->csv, "x,y,z,distance with all digits");
  command->callback([arguments] {
    FieldPrintSettings settings;
    settings.voxel_width = arguments->voxel_width;
    if (!arguments->slice.empty()) settings.slice = parse_slice(arguments->slice);
    if (!arguments->margin.empty()) settings.margin = parse_margin(arguments->margin);
    if (arguments->thickness >= 0) settings.thickness = arguments->thickness;
    settings.csv = arguments->csv;
    const MeshFile file = read_mesh(arguments->mesh);
    require_usable(file.mesh, arguments->mesh);
    print(print_field(file.mesh, settings));
  });
}

}  // namespace muslin::app
