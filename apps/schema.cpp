// muslin schema
#include <memory>

#include "command.hpp"

#include "muslin/fit/measurements.hpp"
#include "muslin/scene/scene_table.hpp"
#include "muslin/schema/publish.hpp"

namespace muslin::app {

void add_schema(CLI::App& program) {
  auto* command = program.add_subcommand("schema", "print the JSON Schema of scene files, for editors");
  auto markdown = std::make_shared<bool>(false);
  auto python = std::make_shared<bool>(false);
  auto* one = command->add_flag("--markdown", *markdown, "print the tables of the guide instead");
  command->add_flag("--python", *python, "print types for Python instead")->excludes(one);
  command->callback([markdown, python] {
    print(*markdown ? schema::markdown(scene_table()) + "\n" + schema::markdown(measurements_table())
          : *python ? schema::python_types(scene_table())
                    : schema::json_schema(scene_table(), "muslin scene"));
  });
}

}  // namespace muslin::app
