#include "arrays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nanobind/stl/string.h>

#include "muslin/core/error.hpp"

namespace muslin::python {
namespace {

std::string text(const nb::object& object) { return nb::str(object).c_str(); }

/// An array of `kinds` ("fiu": numpy's letters) with `ndim` dimensions, the last of `columns` numbers (0:
/// any), as contiguous `dtype`.
nb::object checked(nb::handle given, const std::string& what, const char* kinds, const char* dtype,
                   std::size_t ndim, std::size_t columns) {
  const nb::module_ numpy = nb::module_::import_("numpy");
  nb::object array;
  try {
    array = numpy.attr("asarray")(given);
  } catch (const nb::python_error& error) {
    throw Error(ErrorKind::usage, what + ": no array can be made of it: " + error.what(),
                "give a numpy array or a nested list of numbers");
  }
  const std::string wanted = ndim == 1 && columns == 0 ? "(n,)"
                             : ndim == 1               ? fmt::format("({},)", columns)
                             : columns == 0            ? "(n, k)"
                                                       : fmt::format("(n, {})", columns);
  const bool empty = nb::cast<std::size_t>(array.attr("size")) == 0;
  const auto kind = nb::cast<std::string>(array.attr("dtype").attr("kind"));
  if (!empty && std::string(kinds).find(kind) == std::string::npos) {
    throw Error(ErrorKind::usage, fmt::format("{}: it is an array of {}", what, text(array.attr("dtype"))),
                std::string(kinds) == "fiu" ? "give real numbers" : "give whole numbers");
  }
  const std::size_t given_ndim = nb::cast<std::size_t>(array.attr("ndim"));
  const bool nothing = empty && given_ndim == 1 && ndim == 2;  // an empty list
  if (!nothing &&
      (given_ndim != ndim ||
       (columns > 0 && nb::cast<std::size_t>(array.attr("shape")[nb::int_(ndim - 1)]) != columns))) {
    throw Error(ErrorKind::usage, fmt::format("{}: its shape is {}", what, text(array.attr("shape"))),
                "give an array of shape " + wanted);
  }
  return numpy.attr("ascontiguousarray")(array, nb::arg("dtype") = dtype);
}

template <class Number>
struct Numbers {
  nb::ndarray<const Number, nb::c_contig, nb::device::cpu> array;
  std::size_t size() const { return array.size(); }
  const Number& operator[](std::size_t i) const { return array.data()[i]; }
};

Numbers<double> reals(nb::handle given, const std::string& what, std::size_t ndim, std::size_t columns) {
  Numbers<double> numbers{
      nb::cast<decltype(Numbers<double>::array)>(checked(given, what, "fiu", "float64", ndim, columns))};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (std::isfinite(numbers[i])) continue;
    const std::string at =
        ndim == 2 && columns > 0 ? fmt::format("[{}, {}]", i / columns, i % columns) : fmt::format("[{}]", i);
    throw Error(ErrorKind::usage, fmt::format("{}{} is {}", what, at, numbers[i]), "give finite numbers");
  }
  return numbers;
}

Numbers<std::int64_t> wholes(nb::handle given, const std::string& what, std::size_t columns) {
  const nb::object array = checked(given, what, "iu", "int64", 1, columns);
  Numbers<std::int64_t> numbers{nb::cast<decltype(Numbers<std::int64_t>::array)>(array)};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (numbers[i] >= std::numeric_limits<int>::min() && numbers[i] <= std::numeric_limits<int>::max())
      continue;
    throw Error(ErrorKind::usage, fmt::format("{}[{}] is {}", what, i, numbers[i]), "give smaller numbers");
  }
  return numbers;
}

template <class Kept>
auto own(Kept value) {
  return given_away(std::vector<Kept>(1, std::move(value)));
}

}  // namespace

Array<double, 3> to_array(const Vec3& vector) {
  const auto [kept, owner] = own(vector);
  return Array<double, 3>(kept->front().data(), {3}, owner);
}

Array<int, 3> to_array(const Vec3i& vector) {
  const auto [kept, owner] = own(vector);
  return Array<int, 3>(kept->front().data(), {3}, owner);
}

Array<double, 2, 3> to_array(const Box& box) {
  const auto [kept, owner] = given_away(std::vector<Vec3>{box.min(), box.max()});
  return Array<double, 2, 3>(kept->front().data(), {2, 3}, owner);
}

std::vector<Vec3> as_vectors(nb::handle array, const std::string& what) {
  const Numbers<double> numbers = reals(array, what, 2, 3);
  std::vector<Vec3> vectors(numbers.size() / 3);
  for (std::size_t i = 0; i < vectors.size(); ++i)
    vectors[i] = Vec3(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
  return vectors;
}

std::vector<Vec3> as_vectors(nb::handle array, const std::string& what, std::size_t count) {
  std::vector<Vec3> vectors = as_vectors(array, what);
  if (vectors.size() != count) {
    throw Error(ErrorKind::usage, fmt::format("{}: it has {} rows", what, vectors.size()),
                fmt::format("give one row for each of the {} vertices", count));
  }
  return vectors;
}

std::vector<Vec2> as_plane_vectors(nb::handle array, const std::string& what) {
  const Numbers<double> numbers = reals(array, what, 2, 2);
  std::vector<Vec2> vectors(numbers.size() / 2);
  for (std::size_t i = 0; i < vectors.size(); ++i) vectors[i] = Vec2(numbers[2 * i], numbers[2 * i + 1]);
  return vectors;
}

Vec3 as_vector(nb::handle array, const std::string& what) {
  const Numbers<double> numbers = reals(array, what, 1, 3);
  return Vec3(numbers[0], numbers[1], numbers[2]);
}

Vec3i as_whole_vector(nb::handle array, const std::string& what) {
  const Numbers<std::int64_t> numbers = wholes(array, what, 3);
  return Vec3i(static_cast<int>(numbers[0]), static_cast<int>(numbers[1]), static_cast<int>(numbers[2]));
}

std::vector<double> as_numbers(nb::handle array, const std::string& what) {
  const Numbers<double> numbers = reals(array, what, 1, 0);
  return {numbers.array.data(), numbers.array.data() + numbers.size()};
}

std::vector<int> as_indices(nb::handle array, const std::string& what) {
  const Numbers<std::int64_t> numbers = wholes(array, what, 0);
  return {numbers.array.data(), numbers.array.data() + numbers.size()};
}

}  // namespace muslin::python
