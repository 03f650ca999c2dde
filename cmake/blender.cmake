# Compiles the files of the add-on for Blender into the program, so that `muslin blender-addon` needs no data files. Its
# scene_schema.json is what `muslin schema` prints.
file(GLOB addon CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/blender/muslin_cloth/*.py
     ${PROJECT_SOURCE_DIR}/blender/muslin_cloth/*.toml)
list(APPEND addon ${PROJECT_SOURCE_DIR}/LICENSE)
set(texts "")
foreach(file ${addon})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
  get_filename_component(name ${file} NAME)
  file(READ ${file} text)
  string(APPEND texts "    {\"${name}\", R\"addon(${text})addon\"},\n")
endforeach()
set(generated ${CMAKE_CURRENT_BINARY_DIR}/blender_addon_files.cpp)
file(WRITE ${generated}.new "// Made from blender/muslin_cloth.
#include \"blender_addon_files.hpp\"

namespace muslin::app {
namespace {

constexpr AddonFile files[] = {
${texts}};

}  // namespace

std::span<const AddonFile> blender_addon_files() { return files; }

}  // namespace muslin::app
")
file(COPY_FILE ${generated}.new ${generated} ONLY_IF_DIFFERENT)
