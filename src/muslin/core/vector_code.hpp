// Vector code consists of plain loops compiled once for each instruction set; the best is chosen at run time.
#pragma once

/// Put before a function, compiles clones of it for AVX-512, AVX2 and any other processor. All give the same
/// bits, since no clone contracts or reorders floating-point operations. Functions called inside must be
/// forced inline.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
#define MUSLIN_VECTOR_CODE __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define MUSLIN_VECTOR_CODE
#endif
/// Defined where code is compiled for several instruction sets.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(__SANITIZE_THREAD__) && \
    !defined(__SANITIZE_ADDRESS__)
#define MUSLIN_BY_PROCESSOR
#endif
#define MUSLIN_INLINE [[gnu::always_inline]] inline

/// Put before a loop, states that no iteration reads data that another one writes.
#if defined(__clang__)
#define MUSLIN_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define MUSLIN_INDEPENDENT _Pragma("GCC ivdep")
#else
#define MUSLIN_INDEPENDENT
#endif
