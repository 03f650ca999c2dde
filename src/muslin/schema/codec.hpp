// Codecs read, write and check the values of keys.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include <fmt/format.h>

#include "muslin/core/toml_table.hpp"
#include "muslin/core/vectors.hpp"
#include "muslin/schema/key.hpp"
#include "muslin/schema/value.hpp"

namespace muslin::schema {

struct NumberCodec {
  std::vector<Type> types() const { return {Type::number}; }
  Range range() const { return {}; }
  template <class T>
  T read(const Key& key, const TomlTable& table) const {
    return table.number(key.name, key.unit, key.range);
  }
  TomlValue write(const Key&, double x) const { return real(x); }
  void check(const Key& key, double x, const Subject& subject) const;
};

struct WholeNumberCodec {
  std::vector<Type> types() const { return {Type::whole_number}; }
  Range range() const { return {}; }
  template <class T>
  T read(const Key& key, const TomlTable& table) const {
    return static_cast<T>(read_whole_number(key, table));
  }
  TomlValue write(const Key&, std::int64_t x) const { return whole(x); }
  void check(const Key& key, std::int64_t x, const Subject& subject) const;

 private:
  static std::int64_t read_whole_number(const Key& key, const TomlTable& table);
};

struct TruthCodec {
  std::vector<Type> types() const { return {Type::truth}; }
  Range range() const { return {}; }
  template <class T>
  T read(const Key& key, const TomlTable& table) const {
    return table.boolean(key.name, false);
  }
  TomlValue write(const Key&, bool x) const { return truth_value(x); }
  void check(const Key&, bool, const Subject&) const {}
};

struct TextCodec {
  std::vector<Type> types() const { return {Type::text}; }
  Range range() const { return {}; }
  template <class T>
  T read(const Key& key, const TomlTable& table) const {
    return table.string(key.name);
  }
  TomlValue write(const Key&, const std::string& text) const { return words(text); }
  void check(const Key&, const std::string&, const Subject&) const {}
};

struct TextsCodec {
  using Texts = std::vector<std::string>;

  std::vector<Type> types() const { return {Type::texts}; }
  Range range() const { return {}; }
  template <class T>
  T read(const Key& key, const TomlTable& table) const {
    return read_texts(key, table);
  }
  TomlValue write(const Key&, const Texts& texts) const;
  void check(const Key&, const Texts&, const Subject&) const {}

 private:
  static Texts read_texts(const Key& key, const TomlTable& table);
};

/// The value is one of the key's choices as a text, or the enumerator at its place.
struct WordCodec {
  std::vector<Type> types() const { return {Type::word}; }
  Range range() const { return {}; }
  template <class T>
  T read(const Key& key, const TomlTable& table) const {
    const std::size_t index = table.choice(key.name, key.choices, 0);
    if constexpr (std::is_same_v<T, std::string>) {
      return key.choices[index];
    } else {
      return static_cast<T>(index);
    }
  }
  template <class T>
  TomlValue write(const Key& key, const T& choice) const {
    const std::size_t index = index_of(key, choice);
    return words(index < key.choices.size() ? key.choices[index] : "");
  }
  template <class T>
  void check(const Key& key, const T& choice, const Subject& subject) const {
    check_index(key, index_of(key, choice), subject);
  }

 private:
  template <class T>
  static std::size_t index_of(const Key& key, const T& choice) {
    if constexpr (std::is_same_v<T, std::string>) {
      const auto& words = key.choices;
      return static_cast<std::size_t>(std::find(words.begin(), words.end(), choice) - words.begin());
    } else {
      return static_cast<std::size_t>(choice);
    }
  }
  static void check_index(const Key& key, std::size_t index, const Subject& subject);
};

struct VectorCodec {
  std::vector<Type> types() const { return {Type::vector}; }
  Range range() const { return Range::between(-largest_component, largest_component); }
  template <class T>
  T read(const Key& key, const TomlTable& table) const {
    return read_vector(key, table);
  }
  TomlValue write(const Key&, const Vec3& v) const { return vector_value(v); }
  void check(const Key& key, const Vec3& v, const Subject& subject) const;

 private:
  static Vec3 read_vector(const Key& key, const TomlTable& table);
};

struct DirectionCodec {
  std::string example;

  std::vector<Type> types() const { return {Type::vector}; }
  Range range() const { return Range::between(-largest_component, largest_component); }
  template <class T>
  T read(const Key& key, const TomlTable& table) const {
    const Vec3 v = VectorCodec{}.read<Vec3>(key, table);
    check(key, v, Subject(table));
    return Vec3(v / v.stableNorm());
  }
  TomlValue write(const Key&, const Vec3& v) const { return vector_value(v); }
  void check(const Key& key, const Vec3& v, const Subject& subject) const;
};

struct ColourCodec {
  std::vector<Type> types() const { return {Type::vector}; }
  Range range() const { return Range::between(0, 1); }
  template <class T>
  T read(const Key& key, const TomlTable& table) const {
    const Vec3 colour = table.vector(key.name, key.unit);
    check(key, colour, Subject(table));
    return colour;
  }
  TomlValue write(const Key&, const Vec3& v) const { return vector_value(v); }
  void check(const Key& key, const Vec3& v, const Subject& subject) const;
};

/// A curve through the origin, which may be its first point or left out.
struct CurveCodec {
  using Curve = std::vector<Vec2>;

  std::vector<Type> types() const { return {Type::curve}; }
  Range range() const { return {}; }
  template <class T>
  T read(const Key& key, const TomlTable& table) const {
    return read_curve(key, table);
  }
  TomlValue write(const Key&, const Curve& curve) const;
  void check(const Key& key, const Curve& curve, const Subject& subject) const;

 private:
  static Curve read_curve(const Key& key, const TomlTable& table);
};

/// Returns the tables of a list such as [[pin]]. Errors: input, if it is not a list.
const std::vector<TomlValue>& section_values(const std::string& name, const TomlTable& top);
/// Returns the name of a table of a list in messages: `[[body]] flag`, or with its number.
std::string section_title(const std::string& name, const TomlValue& value, std::size_t index);
/// Returns the tables of a list of keyframes. Errors: input, if there is none.
const std::vector<TomlValue>& keyframe_values(const std::string& name, const TomlTable& owner);
/// Throws Error(input) unless time > before.
void require_later(const TomlTable& keyframe, double before, double time);

}  // namespace muslin::schema
