# Compiles report/page.html into the library, so that `muslin report` needs no data files.
set(page ${PROJECT_SOURCE_DIR}/src/muslin/report/page.html)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${page})
file(READ ${page} text)
set(generated ${CMAKE_CURRENT_BINARY_DIR}/report_template.cpp)
file(WRITE ${generated}.new "// Made from src/muslin/report/page.html.
#include \"muslin/report/report_template.hpp\"

namespace muslin {

std::string_view report_template() { return R\"page(${text})page\"; }

}  // namespace muslin
")
file(COPY_FILE ${generated}.new ${generated} ONLY_IF_DIFFERENT)
list(APPEND edges ${generated})
