# Flags of all our own targets. -ffp-contract=off: the AVX2, AVX-512 and portable clones of a loop
# must give the same bits; a fused multiply-add in one of them would not.
add_library(muslin_flags INTERFACE)
target_compile_options(muslin_flags INTERFACE -Wall -Wextra -Wpedantic -fno-math-errno -ffp-contract=off)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(muslin_flags INTERFACE -Wno-restrict)  # false alarms on std::string, GCC bug 105651
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Collect garbage later: a tenth less time for 200 MB more memory a job.
  target_compile_options(muslin_flags INTERFACE --param=ggc-min-expand=200 --param=ggc-min-heapsize=400000)
endif()
if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  # False alarms on std::stable_sort of libstdc++ 12. Laws fill their constants from a flat list (energy/law.hpp).
  target_compile_options(muslin_flags INTERFACE -Wno-deprecated-declarations -Wno-missing-braces)
endif()
if(MUSLIN_WERROR)
  target_compile_options(muslin_flags INTERFACE -Werror)
endif()
if(MUSLIN_SANITIZE)
  target_compile_options(muslin_flags INTERFACE -fsanitize=${MUSLIN_SANITIZE} -fno-sanitize-recover=all
                         -fno-omit-frame-pointer -g1)
  target_link_options(muslin_flags INTERFACE -fsanitize=${MUSLIN_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    target_compile_options(muslin_flags INTERFACE -Wno-pass-failed)  # checks keep some loops from being vectorised
  endif()
endif()
if(NOT CMAKE_BUILD_TYPE AND PROJECT_IS_TOP_LEVEL)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")  # asserts are for our own mistakes
