#include "muslin/io/vector_grid_file.hpp"

#include <charconv>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include "muslin/core/error.hpp"
#include "muslin/core/input_file.hpp"
#include "muslin/io/binary_reader.hpp"

namespace muslin {
namespace {

constexpr std::string_view npy_magic = "\x93NUMPY";
constexpr std::uint64_t most_numbers = std::uint64_t{1} << 32;

/// One file while it is read.
class NpyReader {
 public:
  NpyReader(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

  VectorGrid read() {
    read_header();
    VectorGrid grid;
    const std::vector<std::uint64_t> shape = shape_of(value_of("shape"));
    if (shape.size() != 4 || shape[3] != 3)
      fail(fmt::format("its shape is ({})", fmt::join(shape, ", ")),
           "give an array of shape (nx, ny, nz, 3)");
    std::uint64_t count = 3;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (shape[axis] < 2 || shape[axis] > most_numbers / count)
        fail(fmt::format("it has {} nodes along an axis", shape[axis]), "give 2 or more, not too many");
      count *= shape[axis];
      grid.size[axis] = shape[axis];
    }
    if (value_of("fortran_order").substr(0, 5) != "False")
      fail("its order is that of Fortran", "save it with np.ascontiguousarray");
    const Scalar type = scalar();
    if (data_.size() / size_of(type) < count)
      fail(fmt::format("it has {} bytes of the {} that its shape needs", data_.size(), count * size_of(type)),
           "save it again");
    grid.vectors.resize(count / 3);
    for (std::size_t n = 0; n < count; ++n) {
      const double number = load_number(data_.data() + n * size_of(type), type, big_endian_);
      if (!std::isfinite(number)) fail(fmt::format("number {} is {}", n, number), "give finite numbers");
      grid.vectors[n / 3][static_cast<Eigen::Index>(n % 3)] = number;
    }
    return grid;
  }

 private:
  [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const {
    throw Error(ErrorKind::input, fmt::format("{}: {}", file_, problem), remedy);
  }
  [[noreturn]] void fail_as_none() const {
    fail("it is no array of NumPy", "save it with np.save, with shape (nx, ny, nz, 3)");
  }

  void read_header() {
    if (bytes_.size() < 12 || bytes_.substr(0, npy_magic.size()) != npy_magic) fail_as_none();
    const bool wide = bytes_[6] != 1;
    const std::size_t begin = wide ? 12 : 10;
    const std::size_t length =
        wide ? load<std::uint32_t>(bytes_.data() + 8, false) : load<std::uint16_t>(bytes_.data() + 8, false);
    if (bytes_.size() - begin < length) fail_as_none();
    header_ = bytes_.substr(begin, length);
    data_ = bytes_.substr(begin + length);
  }

  /// The header from the value of a key on.
  std::string_view value_of(std::string_view key) const {
    const std::size_t at = header_.find(fmt::format("'{}':", key));
    if (at == std::string_view::npos) fail_as_none();
    const std::size_t value = header_.find_first_not_of(' ', at + key.size() + 3);
    if (value == std::string_view::npos) fail_as_none();
    return header_.substr(value);
  }

  std::vector<std::uint64_t> shape_of(std::string_view text) const {
    std::vector<std::uint64_t> shape;
    if (text.front() != '(') fail_as_none();
    text.remove_prefix(1);
    while (true) {
      const std::size_t next = text.find_first_not_of(", ");
      if (next == std::string_view::npos) fail_as_none();
      text.remove_prefix(next);
      if (text.front() == ')') return shape;
      std::uint64_t number = 0;
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
      if (error != std::errc()) fail_as_none();
      shape.push_back(number);
      text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    }
  }

  Scalar scalar() {
    const std::string_view type = value_of("descr").substr(0, 5);
    if (type.size() == 5 && type[0] == '\'' && type[4] == '\'' && type[2] == 'f' &&
        (type[1] == '<' || type[1] == '>') && (type[3] == '4' || type[3] == '8')) {
      big_endian_ = type[1] == '>';
      return type[3] == '4' ? Scalar::float32 : Scalar::float64;
    }
    fail("its numbers are neither float32 nor float64", "convert it with astype(np.float32)");
  }

  std::string_view bytes_, header_, data_;
  const std::string& file_;
  bool big_endian_ = false;
};

}  // namespace

VectorGrid read_vector_grid_from(std::string_view bytes, const std::string& file) {
  return NpyReader(bytes, file).read();
}

VectorGrid read_vector_grid(const std::filesystem::path& path) {
  return read_vector_grid_from(read_file(path), path.string());
}

}  // namespace muslin
