# Configures muslin where two packages are missing: both are named at once, with what to install.
# Called as: cmake -D SOURCE=… -D SCRATCH=… -P missing.cmake
set(build ${SCRATCH}/missing)
file(REMOVE_RECURSE ${build})
execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${build} -DCMAKE_DISABLE_FIND_PACKAGE_assimp=TRUE
                        -DCMAKE_DISABLE_FIND_PACKAGE_PNG=TRUE
                RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
if(code EQUAL 0)
  message(FATAL_ERROR "muslin is configured although packages are missing:\n${out}")
endif()
string(REGEX REPLACE "[ \n]+" " " out "${out}")
foreach(line "apt install libassimp-dev libpng-dev" "dnf install assimp-devel libpng-devel" "pacman -S assimp libpng")
  string(FIND "${out}" "${line}" at)
  if(at LESS 0)
    message(FATAL_ERROR "the message does not say `${line}`:\n${out}")
  endif()
endforeach()
