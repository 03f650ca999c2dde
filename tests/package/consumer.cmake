# Installs muslin into a scratch folder, builds examples/consumer against it with find_package alone, runs it.
# Called as: cmake -D BUILD=… -D SOURCE=… -D SCRATCH=… -P consumer.cmake
file(REMOVE_RECURSE ${SCRATCH})
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(code)
    message(FATAL_ERROR "${ARGV}\n${out}")
  endif()
  set(output "${out}" PARENT_SCOPE)
endfunction()
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${SCRATCH}/prefix)
run(${CMAKE_COMMAND} -S ${SOURCE}/examples/consumer -B ${SCRATCH}/build -G Ninja
    -DCMAKE_PREFIX_PATH=${SCRATCH}/prefix -DCMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build ${SCRATCH}/build)
run(${SCRATCH}/build/consumer ${SCRATCH}/prefix/share/muslin/scenes/thesis/1_rest.toml)
if(NOT output MATCHES "24 10\\.000000 0\\.000000 0\\.000000")
  message(FATAL_ERROR "the consumer's flag did not stay at rest:\n${output}")
endif()

# The guide shows the same program.
file(READ ${SOURCE}/examples/consumer/main.cpp program)
file(READ ${SOURCE}/docs/guide/cpp.md guide)
string(FIND "${program}" "#include" begin)
string(SUBSTRING "${program}" ${begin} -1 program)
string(FIND "${guide}" "${program}" at)
if(at LESS 0)
  message(FATAL_ERROR "docs/guide/cpp.md does not show examples/consumer/main.cpp")
endif()
