// Buffer is memory for the large arrays of a step.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace muslin {

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

}  // namespace muslin
