#include "muslin/core/parallel.hpp"

#include <memory>

#include <tbb/global_control.h>
#include <tbb/info.h>

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

int thread_count() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

}  // namespace muslin
