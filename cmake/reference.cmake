# The target `reference`: pages made from the comments of the public headers, in BUILD/reference/html. Needs doxygen.
find_package(Doxygen QUIET)
if(DOXYGEN_FOUND)
  set(MUSLIN_REFERENCE ${PROJECT_BINARY_DIR}/reference)
  set(MUSLIN_REFERENCE_GUIDE ${PROJECT_SOURCE_DIR}/docs/guide/cpp.md)
  list(TRANSFORM MUSLIN_PUBLIC_HEADERS PREPEND "\"${PROJECT_SOURCE_DIR}/src/muslin/" OUTPUT_VARIABLE headers)
  list(TRANSFORM headers APPEND "\"")
  list(JOIN headers " " MUSLIN_REFERENCE_HEADERS)
  configure_file(cmake/Doxyfile.in ${PROJECT_BINARY_DIR}/Doxyfile @ONLY)
  add_custom_target(reference
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${MUSLIN_REFERENCE}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${MUSLIN_REFERENCE}
    COMMAND Doxygen::doxygen ${PROJECT_BINARY_DIR}/Doxyfile
    COMMAND ${CMAKE_COMMAND} -E echo "open ${MUSLIN_REFERENCE}/html/index.html"
    VERBATIM)
else()
  add_custom_target(reference
    COMMAND ${CMAKE_COMMAND} -E echo "reference: install doxygen (apt, dnf or pacman install it by that name), then run cmake again"
    COMMAND ${CMAKE_COMMAND} -E false VERBATIM)
endif()
