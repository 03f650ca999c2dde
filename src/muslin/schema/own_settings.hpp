// OwnSettings holds the settings of one kind among several, of a type that only the kind knows.
#pragma once

#include <any>
#include <typeinfo>

namespace muslin {

class OwnSettings {
 public:
  /// Returns those of type T, with its defaults where there are none or those of another type.
  template <class T>
  const T& as() const {
    static const T defaults;
    const T* own = std::any_cast<T>(&value_);
    return own != nullptr ? *own : defaults;
  }
  /// Returns them for writing; those of another type are replaced by the defaults of T.
  template <class T>
  T& as() {
    if (value_.type() != typeid(T)) value_ = T();
    return std::any_cast<T&>(value_);
  }

 private:
  std::any value_;
};

}  // namespace muslin
