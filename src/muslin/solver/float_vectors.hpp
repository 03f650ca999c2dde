// FloatVectors are the vectors of the inner solver: float, one array per coordinate.
#pragma once

#include <cstddef>

#include "muslin/core/buffer.hpp"
#include "muslin/core/float4.hpp"

namespace muslin {

/// #V by 3 floats as three arrays.
struct Floats {
  float* x = nullptr;
  float* y = nullptr;
  float* z = nullptr;

  Floats operator+(std::ptrdiff_t i) const { return {x + i, y + i, z + i}; }
};

class FloatVectors {
 public:
  void resize(std::size_t count) {
    size_ = count;
    // An odd number of cache lines apart, so that the three arrays do not compete for the same cache sets.
    stride_ = (count + 1023) / 1024 * 1024 + 336;
    buffer_.resize(3 * stride_);
  }
  Floats data() const { return {buffer_.data(), buffer_.data() + stride_, buffer_.data() + 2 * stride_}; }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return buffer_.bytes(); }

 private:
  Buffer<float> buffer_;
  std::size_t size_ = 0, stride_ = 0;
};

}  // namespace muslin
