// FloatVectors are the vectors of the inner solver: float, one array per coordinate.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace muslin {

/// Four floats in a register.
using Float4 = float __attribute__((vector_size(16)));

/// Uninitialised memory for large arrays, aligned to cache lines; in pages of 2 MB where the system has
/// them, because the lines along the slow axes of a lattice touch a new small page at every vertex.
template <class T>
class Buffer {
 public:
  /// Contents are lost if the buffer has to grow.
  void resize(std::size_t count) {
    size_ = count;
    if (count <= capacity_) return;
    constexpr std::size_t huge_page = std::size_t{1} << 21, line = 64;
    const std::size_t alignment = count * sizeof(T) >= huge_page ? huge_page : line;
    const std::size_t bytes = (count * sizeof(T) + alignment - 1) / alignment * alignment;
    data_.reset();
    capacity_ = 0;
    data_.reset(static_cast<T*>(std::aligned_alloc(alignment, bytes)));
    if (!data_) throw std::bad_alloc();
    capacity_ = bytes / sizeof(T);
#if defined(__linux__)
    if (alignment == huge_page) madvise(data_.get(), bytes, MADV_HUGEPAGE);
#endif
  }
  T* data() const { return data_.get(); }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return capacity_ * sizeof(T); }

 private:
  struct Free {
    void operator()(T* p) const { std::free(p); }
  };
  std::unique_ptr<T, Free> data_;
  std::size_t size_ = 0, capacity_ = 0;
};

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
