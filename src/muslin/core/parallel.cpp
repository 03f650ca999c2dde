#include "muslin/core/parallel.hpp"

#include <memory>

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#if defined(MUSLIN_THREAD_SANITIZER)
#include <sanitizer/tsan_interface.h>
#endif

namespace muslin {
namespace {

std::unique_ptr<tbb::global_control> limit;

// oneTBB is not built for the thread sanitizer. This file, which contains oneTBB's loop, is left out of it,
// and tells it that a loop begins before its blocks and ends after them.
#if defined(MUSLIN_THREAD_SANITIZER)
void order_before(char& place) { __tsan_release(&place); }
void order_after(char& place) { __tsan_acquire(&place); }
#else
void order_before(char&) {}
void order_after(char&) {}
#endif

}  // namespace

void set_thread_count(int count) {
  limit.reset();
  if (count > 0) {
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                  static_cast<std::size_t>(count));
  }
}

void parallel_blocks(std::size_t blocks, void (*call)(const void* body, std::size_t block),
                     const void* body) {
  char begun = 0;
  char ended = 0;
  order_before(begun);
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    order_after(begun);
    call(body, block);
    order_before(ended);
  });
  order_after(ended);
}

int thread_count() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

}  // namespace muslin
