#include "muslin/io/npy_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "muslin/core/error.hpp"

namespace muslin {

NpyArray::NpyArray(std::string_view bytes, std::string file, std::string remedy)
    : file_(std::move(file)), remedy_(std::move(remedy)) {
  read_header(bytes);
  read_type();
  fortran_order_ = value_of("fortran_order").starts_with("True");
  read_shape();
  check_size();
}

double NpyArray::operator[](std::size_t n) const {
  const double number = load_number(data_.data() + n * size_of(type_), type_, big_endian_);
  if (!std::isfinite(number)) refuse(fmt::format("number {}, counted from 0, is not finite", n));
  return number;
}

void NpyArray::refuse(const std::string& problem) const {
  throw Error(ErrorKind::input, Place{file_}, problem, remedy_);
}

void NpyArray::read_header(std::string_view bytes) {
  constexpr std::string_view magic = "\x93NUMPY";
  if (!bytes.starts_with(magic) || bytes.size() < 12) refuse("this is not a file of NumPy");
  const bool wide = bytes[6] != 1;
  const std::size_t begin = wide ? 12 : 10;
  const std::size_t length =
      wide ? load<std::uint32_t>(bytes.data() + 8, false) : load<std::uint16_t>(bytes.data() + 8, false);
  if (length > bytes.size() - begin) refuse("the file is cut off");
  header_ = bytes.substr(begin, length);
  data_ = bytes.substr(begin + length);
}

/// The header from the value of a key on, not empty.
std::string_view NpyArray::value_of(std::string_view key) const {
  const std::string quoted = fmt::format("'{}':", key);
  const std::size_t at = header_.find(quoted);
  const std::size_t value = at == header_.npos ? at : header_.find_first_not_of(' ', at + quoted.size());
  if (value == header_.npos) refuse(fmt::format("its header has no `{}`", key));
  return header_.substr(value);
}

void NpyArray::read_type() {
  constexpr std::array<std::pair<std::string_view, Scalar>, 9> types = {{{"f4", Scalar::float32},
                                                                         {"f8", Scalar::float64},
                                                                         {"i1", Scalar::int8},
                                                                         {"u1", Scalar::uint8},
                                                                         {"b1", Scalar::uint8},
                                                                         {"i2", Scalar::int16},
                                                                         {"u2", Scalar::uint16},
                                                                         {"i4", Scalar::int32},
                                                                         {"u4", Scalar::uint32}}};
  const std::string_view text = value_of("descr");
  if (text.size() > 4 && text[0] == '\'' && text[4] == '\'')
    for (const auto& [name, type] : types)
      if (text.substr(2, 2) == name) {
        type_ = type;
        big_endian_ = text[1] == '>';
        return;
      }
  refuse("its numbers are of another type than floats or integers of up to four bytes");
}

void NpyArray::read_shape() {
  std::string_view text = value_of("shape");
  bool whole = text.front() == '(';
  text.remove_prefix(1);
  while (whole) {
    text.remove_prefix(std::min(text.find_first_not_of(", "), text.size()));
    if (text.starts_with(')')) return;
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    whole = error == std::errc();
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    shape_.push_back(number);
  }
  refuse("its header has no valid `shape`");
}

void NpyArray::check_size() const {
  constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t count = 1;
  for (const std::uint64_t n : shape_) count = n != 0 && count > most / n ? most : count * n;
  const std::size_t size = size_of(type_);
  if (data_.size() % size != 0 || data_.size() / size != count)
    refuse(fmt::format("its data have {} bytes, but {} numbers of {} bytes are expected", data_.size(), count,
                       size));
}

}  // namespace muslin
