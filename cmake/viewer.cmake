# Compiles viewer/dist/page.html into the library, so that `muslin view` needs no data files.
set(page ${PROJECT_SOURCE_DIR}/viewer/dist/page.html)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${page})
file(READ ${page} text)
# In pieces, joined at run time: string literals beyond 64 KiB are not portable.
string(LENGTH "${text}" length)
set(pieces "")
foreach(at RANGE 0 ${length} 60000)
  string(SUBSTRING "${text}" ${at} 60000 piece)
  string(APPEND pieces "    R\"page(${piece})page\",\n")
endforeach()
set(generated ${CMAKE_CURRENT_BINARY_DIR}/page_template.cpp)
file(WRITE ${generated}.new "// Made from viewer/dist/page.html.
#include \"muslin/view/page_template.hpp\"

#include <string>

namespace muslin {
namespace {

constexpr const char* pieces[] = {
${pieces}};

std::string joined_pieces() {
  std::string page;
  for (const char* piece : pieces) page += piece;
  return page;
}

}  // namespace

std::string_view page_template() {
  static const std::string page = joined_pieces();
  return page;
}

}  // namespace muslin
")
file(COPY_FILE ${generated}.new ${generated} ONLY_IF_DIFFERENT)
list(APPEND edges ${generated})
