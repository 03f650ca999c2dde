// muslin blender-addon -o ZIP
#include <filesystem>
#include <memory>
#include <string>

#include "blender_addon_files.hpp"
#include "command.hpp"
#include <fmt/format.h>

#include "muslin/core/error.hpp"
#include "muslin/core/input_file.hpp"
#include "muslin/core/output_file.hpp"
#include "muslin/scene/scene_table.hpp"
#include "muslin/schema/publish.hpp"
#include "muslin/view/zip_archive.hpp"

namespace muslin::app {
namespace {

namespace fs = std::filesystem;
constexpr const char* folder = "muslin_cloth/";

/// Adds this program, and the libraries of its own that lie in ../lib, as in an installed wheel.
void add_program(ZipArchive& archive) {
  const fs::path program = fs::read_symlink("/proc/self/exe");
  archive.add(fmt::format("{}bin/muslin", folder), read_file(program), true);
  const fs::path libraries = program.parent_path().parent_path() / "lib";
  for (const char* name : {"libmuslin.so", "libmuslin_cxx.so"})
    if (program.parent_path().filename() == "bin" && fs::exists(libraries / name))
      archive.add(fmt::format("{}lib/{}", folder, name), read_file(libraries / name), true);
}

}  // namespace

void add_blender_addon(CLI::App& program) {
  struct Arguments {
    std::string zip;
    bool without_program = false;
  };
  auto* command =
      program.add_subcommand("blender-addon", "write the add-on for Blender, with this program inside");
  auto a = std::make_shared<Arguments>();
  command->add_option("-o,--output", a->zip, "FILE.zip, which Blender installs")->required();
  command->add_flag("--without-program", a->without_program,
                    "leave the program out; the add-on then uses the one on the PATH");
  command->callback([a] {
    const fs::path path(a->zip);
    if (path.extension() != ".zip")
      throw Error(ErrorKind::usage, {path.string()}, "an add-on must end in .zip", "name it FILE.zip");
    ZipArchive archive;
    for (const AddonFile& file : blender_addon_files())
      archive.add(fmt::format("{}{}", folder, file.name), file.text);
    archive.add(fmt::format("{}scene_schema.json", folder),
                schema::json_schema(scene_table(), "muslin scene"));
    if (!a->without_program) add_program(archive);
    const std::string bytes = archive.finish();
    if (path.has_parent_path()) fs::create_directories(path.parent_path());
    OutputFile out(path, OutputFile::Mode::replace);
    out.append(bytes);
    out.close();
    print(fmt::format("{} ({:.1f} MB)\n", path.string(), static_cast<double>(bytes.size()) / 1e6));
  });
}

}  // namespace muslin::app
