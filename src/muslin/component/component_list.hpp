// ComponentList holds the components of a model, shared and immutable.
#pragma once

#include <cstddef>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

#include "muslin/component/component.hpp"

namespace muslin {

/// A list whose elements are `const Component&`. Copies share them.
class ComponentList {
 public:
  class Iterator {
   public:
    using iterator_category = std::forward_iterator_tag;
    using value_type = Component;
    using difference_type = std::ptrdiff_t;
    using pointer = const Component*;
    using reference = const Component&;

    Iterator() = default;
    explicit Iterator(const std::shared_ptr<const Component>* at) : at_(at) {}
    reference operator*() const { return **at_; }
    pointer operator->() const { return at_->get(); }
    Iterator& operator++() {
      ++at_;
      return *this;
    }
    Iterator operator++(int) { return Iterator(at_++); }
    bool operator==(const Iterator&) const = default;

   private:
    const std::shared_ptr<const Component>* at_ = nullptr;
  };

  void push_back(std::shared_ptr<const Component> component) { all_.push_back(std::move(component)); }
  std::size_t size() const { return all_.size(); }
  bool empty() const { return all_.empty(); }
  const Component& operator[](std::size_t i) const { return *all_[i]; }
  const Component& front() const { return *all_.front(); }
  Iterator begin() const { return Iterator(all_.data()); }
  Iterator end() const { return Iterator(all_.data() + all_.size()); }
  /// Returns the index of a component in the list.
  int index_of(const Component& component) const {
    int index = 0;
    while (all_[static_cast<std::size_t>(index)].get() != &component) ++index;
    return index;
  }

 private:
  std::vector<std::shared_ptr<const Component>> all_;
};

}  // namespace muslin
