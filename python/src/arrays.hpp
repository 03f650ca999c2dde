// Between the engine's vectors and numpy arrays.
//
// Out: `view` shows memory of the engine without a copy, read-only; the array keeps its owner alive. `taken`
// gives a vector away to an array of its own, without a copy, writable. In: `as_vectors` and its like take
// whatever numpy can make an array of, check it, and say what is wrong with it.
#pragma once

#include <array>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include "muslin/core/vectors.hpp"

namespace nb = nanobind;

namespace muslin::python {

/// Whatever numpy can make an array of; numbers are checked by the functions below.
class ArrayLike : public nb::object {
  static bool anything(nb::handle) { return true; }
  NB_OBJECT_DEFAULT(ArrayLike, nb::object, "numpy.typing.ArrayLike", anything)
};

/// Arrays that read out the engine: read-only if their elements are const.
template <class Number, nb::ssize_t... Shape>
using Array = nb::ndarray<nb::numpy, Number, nb::shape<Shape...>, nb::c_contig>;

/// A view of `rows` × `columns` numbers of the engine. `owner` is the Python object that keeps them alive.
template <class Number>
Array<const Number, -1, -1> view_table(const Number* data, std::size_t rows, std::size_t columns,
                                       nb::handle owner) {
  return Array<const Number, -1, -1>(data, {rows, columns}, owner);
}
inline Array<const double, -1, 3> view(ConstVectors vectors, nb::handle owner) {
  return Array<const double, -1, 3>(reinterpret_cast<const double*>(vectors.data()), {vectors.size(), 3},
                                    owner);
}
inline Array<const int, -1, 3> view(const std::vector<Vec3i>& vectors, nb::handle owner) {
  return Array<const int, -1, 3>(reinterpret_cast<const int*>(vectors.data()), {vectors.size(), 3}, owner);
}
inline Array<const double, -1, 2> view(const std::vector<Vec2>& vectors, nb::handle owner) {
  return Array<const double, -1, 2>(reinterpret_cast<const double*>(vectors.data()), {vectors.size(), 2},
                                    owner);
}
template <class Number>
  requires std::is_arithmetic_v<Number>
Array<const Number, -1> view(const std::vector<Number>& numbers, nb::handle owner) {
  return Array<const Number, -1>(numbers.data(), {numbers.size()}, owner);
}
template <class Number, std::size_t columns>
Array<const Number, -1, static_cast<nb::ssize_t>(columns)> view(
    const std::vector<std::array<Number, columns>>& rows, nb::handle owner) {
  return Array<const Number, -1, static_cast<nb::ssize_t>(columns)>(
      reinterpret_cast<const Number*>(rows.data()), {rows.size(), columns}, owner);
}

/// The vector, kept alive by the capsule that is returned.
template <class Vector>
std::pair<Vector*, nb::capsule> given_away(Vector vector) {
  auto* kept = new Vector(std::move(vector));
  return {kept, nb::capsule(kept, [](void* data) noexcept { delete static_cast<Vector*>(data); })};
}
inline Array<double, -1, 3> taken(std::vector<Vec3> vectors) {
  const auto [kept, owner] = given_away(std::move(vectors));
  return Array<double, -1, 3>(reinterpret_cast<double*>(kept->data()), {kept->size(), 3}, owner);
}
inline Array<float, -1, 3> taken(std::vector<Eigen::Vector3f> vectors) {
  const auto [kept, owner] = given_away(std::move(vectors));
  return Array<float, -1, 3>(reinterpret_cast<float*>(kept->data()), {kept->size(), 3}, owner);
}
template <class Number>
  requires std::is_arithmetic_v<Number>
Array<Number, -1> taken(std::vector<Number> numbers) {
  const auto [kept, owner] = given_away(std::move(numbers));
  return Array<Number, -1>(kept->data(), {kept->size()}, owner);
}
template <class Number, std::size_t columns>
Array<Number, -1, static_cast<nb::ssize_t>(columns)> taken(std::vector<std::array<Number, columns>> rows) {
  const auto [kept, owner] = given_away(std::move(rows));
  return Array<Number, -1, static_cast<nb::ssize_t>(columns)>(reinterpret_cast<Number*>(kept->data()),
                                                              {kept->size(), columns}, owner);
}

/// A vector of three, as an array of its own.
Array<double, 3> to_array(const Vec3& vector);
Array<int, 3> to_array(const Vec3i& vector);
/// Lowest and highest corner.
Array<double, 2, 3> to_array(const Box& box);

/// (n, 3) finite numbers; `what` is how messages call them, as in "positions". Errors: usage, saying which
/// shape or number is wrong.
std::vector<Vec3> as_vectors(nb::handle array, const std::string& what);
/// Converts likewise and checks that there are exactly `count` rows.
std::vector<Vec3> as_vectors(nb::handle array, const std::string& what, std::size_t count);
std::vector<Vec2> as_plane_vectors(nb::handle array, const std::string& what);
Vec3 as_vector(nb::handle array, const std::string& what);
/// Three whole numbers.
Vec3i as_whole_vector(nb::handle array, const std::string& what);
std::vector<double> as_numbers(nb::handle array, const std::string& what);
/// (n,) whole numbers that fit an int.
std::vector<int> as_indices(nb::handle array, const std::string& what);

}  // namespace muslin::python
