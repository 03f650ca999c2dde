#include "muslin/core/parallel.hpp"

#include <memory>

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

namespace muslin {
namespace {

std::unique_ptr<tbb::global_control> limit;

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
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) { call(body, block); });
}

int thread_count() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

}  // namespace muslin
