// Declares keys by the member of the settings that holds their value:
//
//   number("duration", &TimeSettings::duration).unit("s").range({0, 1e9, true}).means("simulated time")
//
// A member may be an std::optional: then the key has no value if it is not given.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "muslin/core/vectors.hpp"
#include "muslin/schema/codec.hpp"
#include "muslin/schema/key.hpp"
#include "muslin/schema/table.hpp"
#include "muslin/schema/value.hpp"
#include "muslin/schema/variation.hpp"
#include "muslin/schema/variation_table.hpp"

namespace muslin::schema {

/// A key under construction.
class Declaration {
 public:
  explicit Declaration(Key key) : key_(std::move(key)) {}
  operator Key() const { return key_; }  // NOLINT(google-explicit-constructor): stands in lists of keys

  Declaration& unit(std::string unit) { return set(&Key::unit, std::move(unit)); }
  Declaration& range(Range range) { return set(&Key::range, range); }
  Declaration& means(std::string meaning) { return set(&Key::meaning, std::move(meaning)); }
  /// States the default in words if it is not a constant.
  Declaration& otherwise(std::string words) { return set(&Key::otherwise, std::move(words)); }
  Declaration& may_change_on_resume() { return set(&Key::may_change_on_resume, true); }
  /// Makes the key required; `remedy` tells the user what to do if the type is not clear enough.
  Declaration& required(std::string remedy = {}) {
    key_.missing = std::move(remedy);
    return set(&Key::required, true);
  }
  Declaration& required_without(std::vector<std::string> others) {
    key_.unless = std::move(others);
    return set(&Key::required, true);
  }
  Declaration& needs(std::string other, std::string remedy) {
    key_.needs.push_back({std::move(other), std::move(remedy)});
    return *this;
  }
  Declaration& excludes(std::string other, std::string problem, std::string remedy = "keep one of them") {
    key_.conflicts.push_back({std::move(other), std::move(problem), std::move(remedy)});
    return *this;
  }
  /// States why a number cannot have keyframes.
  Declaration& steady(std::string reason) { return set(&Key::steady, std::move(reason)); }
  /// Lets a number vary in these forms; `list` holds the variation, the key's member then the nominal value.
  template <class S>
  Declaration& varies(Variations S::* list, VaryingForms forms) {
    if (!forms.any()) return *this;
    key_.forms = forms;
    key_.types.push_back(Type::table);
    key_.table = variation_table;
    key_.read = [list, number = key_](const Key& key, const TomlTable& table, void* s) {
      Variations& variations = static_cast<S*>(s)->*list;
      forget_variation(variations, key.name);
      if (table.find(key.name)->type != TomlValue::Type::table) return number.read(key, table, s);
      Variation variation = read_variation(key, table);
      number.set(variation.nominal(), s);
      variations.push_back(std::move(variation));
    };
    key_.write = [list, number = key_](const Key& key, const void* s, TomlValue& out) {
      const Variation* variation = find_variation(static_cast<const S*>(s)->*list, key.name);
      if (variation == nullptr) return number.write(key, s, out);
      append(out, key.name, variation_table().write(*variation));
    };
    key_.check = [list, number = key_](const Key& key, const void* s, const Subject& subject) {
      number.check(key, s, subject);
      const Variation* variation = find_variation(static_cast<const S*>(s)->*list, key.name);
      if (variation != nullptr) check_variation(key, *variation, subject);
    };
    return *this;
  }
  /// Shows the key in the resolved scene only where the predicate holds.
  template <class S, class Predicate>
  Declaration& shown_if(Predicate predicate) {
    key_.shown = [predicate](const void* s) -> bool { return predicate(*static_cast<const S*>(s)); };
    return *this;
  }
  /// Shows this value in the resolved scene in place of the member.
  template <class S, class Value>
  Declaration& shown_as(Value value) {
    key_.write = [value](const Key& key, const void* s, TomlValue& out) {
      append(out, key.name, value(*static_cast<const S*>(s)));
    };
    return *this;
  }

 private:
  template <class T, class U>
  Declaration& set(T Key::* member, U value) {
    key_.*member = std::move(value);
    return *this;
  }

  Key key_;
};

/// A key with custom functions read(key, table, settings) and write(key, settings, table).
template <class S, class Read, class Write>
Declaration custom(std::string name, std::vector<Type> types, Read read, Write write) {
  Key key;
  key.name = std::move(name);
  key.types = std::move(types);
  key.read = [read](const Key& k, const TomlTable& table, void* s) { read(k, table, *static_cast<S*>(s)); };
  key.write = [write](const Key& k, const void* s, TomlValue& out) {
    write(k, *static_cast<const S*>(s), out);
  };
  return Declaration(std::move(key));
}

template <class T>
struct Optional : std::false_type {};
template <class T>
struct Optional<std::optional<T>> : std::true_type {};

/// A key whose value the codec reads, writes and checks. `S` owns the member.
template <class S, class T, class Codec>
Declaration stored(std::string name, T S::* member, Codec codec) {
  constexpr bool optional = Optional<T>::value;
  Key key;
  key.name = std::move(name);
  key.types = codec.types();
  key.range = codec.range();
  key.read = [=](const Key& k, const TomlTable& table, void* s) {
    static_cast<S*>(s)->*member = codec.template read<T>(k, table);
  };
  key.write = [=](const Key& k, const void* s, TomlValue& out) {
    const T& value = static_cast<const S*>(s)->*member;
    if constexpr (optional) {
      if (value) append(out, k.name, codec.write(k, *value));
    } else {
      append(out, k.name, codec.write(k, value));
    }
  };
  key.check = [=](const Key& k, const void* s, const Subject& subject) {
    const T& value = static_cast<const S*>(s)->*member;
    if constexpr (optional) {
      if (value) codec.check(k, *value, subject);
    } else {
      codec.check(k, value, subject);
    }
  };
  if constexpr (optional)
    key.given = [=](const void* s) { return (static_cast<const S*>(s)->*member).has_value(); };
  return Declaration(std::move(key));
}

template <class S, class T>
Declaration number(std::string name, T S::* member) {
  Key key = stored(std::move(name), member, NumberCodec{});
  key.set = [member](double x, void* s) { static_cast<S*>(s)->*member = x; };
  return Declaration(std::move(key));
}
/// Without an upper bound of the range, any 64-bit integer is allowed.
template <class S, class T>
Declaration whole_number(std::string name, T S::* member) {
  return stored(std::move(name), member, WholeNumberCodec{});
}
template <class S, class T>
Declaration truth(std::string name, T S::* member) {
  return stored(std::move(name), member, TruthCodec{});
}
template <class S, class T>
Declaration text(std::string name, T S::* member) {
  return stored(std::move(name), member, TextCodec{});
}
template <class S, class T>
Declaration texts(std::string name, T S::* member) {
  return stored(std::move(name), member, TextsCodec{});
}
/// The member is a text, or an enumeration whose values are in the order of `choices`.
template <class S, class T>
Declaration word(std::string name, T S::* member, std::vector<std::string> choices) {
  Key key = stored(std::move(name), member, WordCodec{});
  key.choices = std::move(choices);
  return Declaration(std::move(key));
}
/// Three numbers, by default within ±largest_component.
template <class S, class T>
Declaration vector(std::string name, T S::* member) {
  return stored(std::move(name), member, VectorCodec{});
}
/// A vector that is not 0, stored with length 1.
template <class S, class T>
Declaration direction(std::string name, T S::* member, std::string example) {
  return stored(std::move(name), member, DirectionCodec{std::move(example)});
}
/// A curve from the origin through at most `most` points; the range is that of the first numbers.
template <class S, class T>
Declaration curve(std::string name, T S::* member, int most) {
  Key key = stored(std::move(name), member, CurveCodec{});
  key.count = static_cast<std::size_t>(most);
  return Declaration(std::move(key));
}
template <class S, class T>
Declaration colour(std::string name, T S::* member) {
  return stored(std::move(name), member, ColourCodec{}).unit("sRGB 0 to 1");
}

/// A path; empty: none. `place` receives its place in the file.
template <class S>
Declaration path(std::string name, std::string S::* member, Place S::* place) {
  Key key = custom<S>(
      std::move(name), {Type::path},
      [=](const Key& k, const TomlTable& table, S& s) {
        s.*member = table.string(k.name);
        require_path(s.*member, k, table);
        s.*place = table.place(k.name);
      },
      [=](const Key& k, const S& s, TomlValue& out) {
        if (!(s.*member).empty()) append(out, k.name, words(s.*member));
      });
  key.given = [=](const void* s) { return !(static_cast<const S*>(s)->*member).empty(); };
  return Declaration(std::move(key));
}

/// A table in a table. Messages about settings made by a program name its keys without the table's name.
template <class S, class T>
Declaration nested(std::string name, T S::* member, const Table& (*keys)()) {
  constexpr bool optional = Optional<T>::value;
  Key key = custom<S>(
      std::move(name), {Type::table},
      [=](const Key& k, const TomlTable& owner, S& s) {
        const TomlTable table =
            keys().open(*owner.find(k.name), fmt::format("`{}` of {}", k.name, owner.title()));
        if constexpr (optional) {
          keys().read(table, (s.*member).emplace());
        } else {
          keys().read(table, s.*member);
        }
      },
      [=](const Key& k, const S& s, TomlValue& out) {
        if constexpr (optional) {
          if (s.*member) append(out, k.name, keys().write(*(s.*member)));
        } else {
          append(out, k.name, keys().write(s.*member));
        }
      });
  key.table = keys;
  key.check = [=](const Key&, const void* s, const Subject& subject) {
    const T& value = static_cast<const S*>(s)->*member;
    if constexpr (optional) {
      if (value) keys().check(*value, subject);
    } else {
      keys().check(value, subject);
    }
  };
  return Declaration(std::move(key));
}

/// A table at the top of the file, such as [time]. finish(table, settings) is called once it is read.
template <class S, class T, class Finish>
Declaration section(std::string name, T S::* member, const Table& (*keys)(), Finish finish) {
  Key key = nested(std::move(name), member, keys);
  key.read = [=](const Key& k, const TomlTable& top, void* s) {
    S& settings = *static_cast<S*>(s);
    const TomlTable table = keys().open(*top.find(k.name), fmt::format("`{}` of {}", k.name, top.title()));
    keys().read(table, settings.*member);
    finish(table, settings);
  };
  key.check = [=](const Key& k, const void* s, const Subject&) {
    const T& value = static_cast<const S*>(s)->*member;
    Place place;
    if constexpr (requires { value.place; }) place = value.place;
    keys().check(value, Subject(fmt::format("[{}]", k.name), place));
  };
  return Declaration(std::move(key));
}
inline constexpr auto nothing = [](const TomlTable&, const auto&) {};

/// A list of tables at the top of the file, such as [[pin]]. finish(table, index, item, settings) completes
/// each item, with data that depends on the rest of the scene, before it is appended.
template <class S, class T, class Finish>
Declaration sections(std::string name, std::vector<T> S::* member, const Table& (*keys)(), Finish finish) {
  Key key = custom<S>(
      std::move(name), {Type::tables},
      [=](const Key& k, const TomlTable& top, S& s) {
        for (const TomlValue& value : section_values(k.name, top)) {
          const std::size_t index = (s.*member).size();
          const TomlTable table = keys().open(value, section_title(k.name, value, index));
          T item;
          keys().read(table, item);
          finish(table, index, item, s);
          (s.*member).push_back(std::move(item));
        }
      },
      [=](const Key& k, const S& s, TomlValue& out) {
        TomlValue items = list({});
        for (const T& item : s.*member) items.items.push_back(keys().write(item));
        append(out, k.name, std::move(items));
      });
  key.table = keys;
  key.check = [=](const Key& k, const void* s, const Subject&) {
    for (const T& item : static_cast<const S*>(s)->*member)
      keys().check(item, Subject(fmt::format("[[{}]] `{}`", k.name, item.name), item.place));
  };
  return Declaration(std::move(key));
}

/// A list of tables whose `time` ascends strictly.
template <class S, class T>
Declaration keyframes(std::string name, std::vector<T> S::* member, const Table& (*keys)()) {
  Key key = custom<S>(
      std::move(name), {Type::tables},
      [=](const Key& k, const TomlTable& owner, S& s) {
        (s.*member).clear();
        for (const TomlValue& value : keyframe_values(k.name, owner)) {
          const TomlTable table = keys().open(value, "a keyframe of " + owner.title());
          T item;
          keys().read(table, item);
          if (!(s.*member).empty()) require_later(table, (s.*member).back().time, item.time);
          (s.*member).push_back(item);
        }
      },
      [=](const Key& k, const S& s, TomlValue& out) {
        TomlValue items = list({});
        for (const T& item : s.*member) items.items.push_back(keys().write(item));
        append(out, k.name, std::move(items));
      });
  key.table = keys;
  key.given = [=](const void* s) { return !(static_cast<const S*>(s)->*member).empty(); };
  key.check = [=](const Key& k, const void* s, const Subject& subject) {
    const std::vector<T>& items = static_cast<const S*>(s)->*member;
    for (std::size_t i = 0; i < items.size(); ++i) {
      if (!std::isfinite(items[i].time) || (i > 0 && !(items[i].time > items[i - 1].time)))
        throw subject.error(k.name, fmt::format("keyframe {} is at {} s", i, items[i].time),
                            "give times that ascend");
      keys().check(items[i], subject);
    }
  };
  return Declaration(std::move(key));
}

/// Adapts a key of some settings to settings Outer that contain them. `find` is a pointer to the member that
/// holds them, or a function from Outer& and const Outer& to a reference.
template <class Outer, class Find>
Key within(Find find, Key key) {
  const auto inner = [find](const void* s) -> const void* {
    return &std::invoke(find, *static_cast<const Outer*>(s));
  };
  key.read = [find, read = key.read](const Key& k, const TomlTable& table, void* s) {
    read(k, table, &std::invoke(find, *static_cast<Outer*>(s)));
  };
  key.write = [inner, write = key.write](const Key& k, const void* s, TomlValue& out) {
    write(k, inner(s), out);
  };
  if (key.check) {
    key.check = [inner, check = key.check](const Key& k, const void* s, const Subject& subject) {
      check(k, inner(s), subject);
    };
  }
  if (key.set) {
    key.set = [find, set = key.set](double x, void* s) {
      set(x, &std::invoke(find, *static_cast<Outer*>(s)));
    };
  }
  if (key.given) key.given = [inner, given = key.given](const void* s) { return given(inner(s)); };
  if (key.shown) key.shown = [inner, shown = key.shown](const void* s) { return shown(inner(s)); };
  return key;
}

/// A table of keys of settings S.
template <class S>
Table table_of(std::string name, std::vector<Key> keys) {
  Table table;
  table.name = std::move(name);
  table.keys = std::move(keys);
  table.type = &typeid(S);
  table.blank = std::make_shared<const S>();
  if constexpr (requires(S& s) { s.place; })
    table.set_place = [](const Place& place, void* s) { static_cast<S*>(s)->place = place; };
  return table;
}

/// Adds the keys, the completion and the rules of a table of settings that `find` finds, as for `within`.
template <class Outer, class Find>
void include(Table& table, Find find, const Table& inner) {
  for (const Key& key : inner.keys) table.keys.push_back(within<Outer>(find, key));
  if (inner.complete) {
    table.complete = [find, complete = inner.complete](const TomlTable& given, void* s) {
      complete(given, &std::invoke(find, *static_cast<Outer*>(s)));
    };
  }
  for (const auto& rule : inner.rules) {
    table.rules.push_back([find, rule](const void* s, const Subject& subject) {
      rule(&std::invoke(find, *static_cast<const Outer*>(s)), subject);
    });
  }
}

/// Lets the key `name`, whose value is the member, select further keys. A member of an enumeration has the
/// order of the variants, a text is the word of one.
template <class S, class T>
void choose(Table& table, std::string_view name, T S::* member, std::vector<Variant> variants) {
  const auto at =
      std::find_if(table.keys.begin(), table.keys.end(), [&](const Key& key) { return key.name == name; });
  table.chooser = static_cast<std::size_t>(at - table.keys.begin());
  table.variants = std::move(variants);
  table.chosen = [member, words = at->choices](const void* s) {
    const T& value = static_cast<const S*>(s)->*member;
    if constexpr (std::is_same_v<T, std::string>) {
      return static_cast<std::size_t>(std::find(words.begin(), words.end(), value) - words.begin());
    } else {
      return static_cast<std::size_t>(value);
    }
  };
}

/// Adds a rule of several keys: rule(settings, subject) throws subject.error(…).
template <class S, class Rule>
void add_rule(Table& table, Rule rule) {
  table.rules.push_back(
      [rule](const void* s, const Subject& subject) { rule(*static_cast<const S*>(s), subject); });
}

}  // namespace muslin::schema
