# Compiles materials/*.toml into the library, so that an installed program needs no data files.
file(GLOB materials CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/materials/*.toml)
list(SORT materials)
set(texts "")
foreach(material ${materials})
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${material})
  get_filename_component(name ${material} NAME_WE)
  file(READ ${material} text)
  string(APPEND texts "    {\"${name}\", R\"toml(${text})toml\"},\n")
endforeach()
set(generated ${CMAKE_CURRENT_BINARY_DIR}/material_library.cpp)
file(WRITE ${generated}.new "// Made from materials/*.toml.
#include \"muslin/material/library.hpp\"

namespace muslin {
namespace {

constexpr LibraryMaterial materials[] = {
${texts}};

}  // namespace

std::span<const LibraryMaterial> material_library() { return materials; }

}  // namespace muslin
")
file(COPY_FILE ${generated}.new ${generated} ONLY_IF_DIFFERENT)
list(APPEND edges ${generated})
