// Reads NumPy's `.npy` files. Source: NumPy Enhancement Proposal 1, A Simple File Format for NumPy Arrays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "muslin/io/binary_reader.hpp"

namespace muslin {

/// An array of floats, integers or truths of at most eight, four and one bytes.
class NpyArray {
 public:
  /// Reads the header, of format version 1 to 3; `bytes` must outlive the array. `file` and `remedy` are for
  /// messages. Errors: input, if it is malformed, of another type, or has another number of bytes.
  NpyArray(std::string_view bytes, std::string file, std::string remedy);

  const std::vector<std::uint64_t>& shape() const { return shape_; }
  /// True if the first index is the one that varies fastest.
  bool has_fortran_order() const { return fortran_order_; }
  std::size_t size() const { return data_.size() / size_of(type_); }
  /// Returns number n < size() in the order of the file. Errors: input, if it is not finite.
  double operator[](std::size_t n) const;

  /// Throws Error(input) with the file and its remedy.
  [[noreturn]] void refuse(const std::string& problem) const;

 private:
  void read_header(std::string_view bytes);
  std::string_view value_of(std::string_view key) const;
  void read_type();
  void read_shape();
  void check_size() const;

  std::string file_, remedy_;
  std::string_view header_, data_;
  std::vector<std::uint64_t> shape_;
  bool fortran_order_ = false, big_endian_ = false;
  Scalar type_ = Scalar::float64;
};

}  // namespace muslin
