# Configures muslin where two packages are missing, and where nothing is, not even a compiler: all that is missing is
# named at once, with what to install.
# Called as: cmake -D SOURCE=… -D SCRATCH=… -P missing.cmake
set(build ${SCRATCH}/missing)
file(REMOVE_RECURSE ${build})
# expect(LINE…): the output has each of them.
function(expect code out)
  if(code EQUAL 0)
    message(FATAL_ERROR "muslin is configured although packages are missing:\n${out}")
  endif()
  string(REGEX REPLACE "[ \n]+" " " out "${out}")
  foreach(line ${ARGN})
    string(FIND "${out}" "${line}" at)
    if(at LESS 0)
      message(FATAL_ERROR "the message does not say `${line}`:\n${out}")
    endif()
  endforeach()
endfunction()

execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${build} -DCMAKE_DISABLE_FIND_PACKAGE_assimp=TRUE
                        -DCMAKE_DISABLE_FIND_PACKAGE_PNG=TRUE
                RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
expect("${code}" "${out}" "apt install libassimp-dev libpng-dev" "dnf install assimp-devel libpng-devel"
       "pacman -S assimp libpng")

# What `pip install` meets on a bare system: the configuration of the module, where there is no compiler.
file(REMOVE_RECURSE ${build})
execute_process(COMMAND ${CMAKE_COMMAND} -E env --unset=CXX PATH=${build}/nothing
                        ${CMAKE_COMMAND} -S ${SOURCE} -B ${build} -D MUSLIN_BUILD_PYTHON=ON -D CMAKE_SYSTEM_PREFIX_PATH=${build}
                RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
expect("${code}" "${out}" "a C++ compiler" "apt install g++ libtbb-dev" "python3-dev" "dnf install gcc-c++ tbb-devel")
