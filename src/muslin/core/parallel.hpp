// Provides parallel loops that give the same bits for any thread count: work is cut into blocks whose size
// depends on the problem alone, and partial sums are added in the order of the blocks.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "muslin/api.hpp"

namespace muslin {

/// Limits all parallel work of the process to `count` threads; 0 means one per core.
MUSLIN_API void set_thread_count(int count);
MUSLIN_API int thread_count();

/// Calls call(body, block) for block = 0 … blocks − 1, in parallel and in any order.
MUSLIN_API void parallel_blocks(std::size_t blocks, void (*call)(const void* body, std::size_t block),
                                const void* body);

/// Calls body(begin, end) for consecutive blocks of at most `grain` indices that cover [0, count).
template <class Body>
void parallel_for(std::size_t count, std::size_t grain, const Body& body) {
  if (count <= grain) {
    if (count > 0) body(std::size_t{0}, count);
    return;
  }
  const auto on_block = [&](std::size_t block) { body(block * grain, std::min(count, (block + 1) * grain)); };
  parallel_blocks(
      (count + grain - 1) / grain,
      [](const void* of, std::size_t block) { (*static_cast<const decltype(on_block)*>(of))(block); },
      &on_block);
}

/// Returns the sum of body(begin, end) over the blocks of parallel_for, added in order.
template <class Value, class Body>
Value parallel_sum(std::size_t count, std::size_t grain, Value zero, const Body& body) {
  if (count <= grain) return count > 0 ? Value(zero + body(std::size_t{0}, count)) : zero;
  std::vector<Value> partial((count + grain - 1) / grain, zero);
  parallel_for(count, grain,
               [&](std::size_t begin, std::size_t end) { partial[begin / grain] = body(begin, end); });
  Value sum = zero;
  for (const Value& value : partial) sum = sum + value;
  return sum;
}

/// Returns the values that body(begin, end, out) appends to `out` (a std::vector<Value>) for the blocks of
/// parallel_for, in their order.
template <class Value, class Body>
std::vector<Value> parallel_collect(std::size_t count, std::size_t grain, const Body& body) {
  std::vector<Value> all;
  if (count <= grain) {
    if (count > 0) body(std::size_t{0}, count, all);
    return all;
  }
  std::vector<std::vector<Value>> parts((count + grain - 1) / grain);
  parallel_for(count, grain,
               [&](std::size_t begin, std::size_t end) { body(begin, end, parts[begin / grain]); });
  std::size_t size = 0;
  for (const auto& part : parts) size += part.size();
  all.reserve(size);
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace muslin
