#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "udar/case/document.hpp"
#include "udar/case/kinds.hpp"
#include "udar/case/mistakes.hpp"
#include "udar/case/path.hpp"
#include "udar/units/parameter.hpp"

namespace udar {

/// The documentation of a key and of a table of keys.
struct KeyText {
  std::string name;
  std::string value;     ///< what may stand there
  std::string standard;  ///< the default as TOML; "" where there is none
  std::string doc;
  std::string example;
  bool required = false;
};
/// Keys that belong to one choice: `law = "tresca"`.
struct ChoiceText {
  std::string choice;
  std::string doc;
  std::vector<KeyText> keys;
};
struct TableText {
  std::string header;  ///< "[bodies.NAME]", "mesh = { ... } in [bodies.NAME]"
  std::string path;    ///< "bodies.NAME.mesh"
  std::string doc;
  std::vector<KeyText> keys;
  std::vector<ChoiceText> choices;
};

/// A key of the table that an Owner is read from. It is declared once; reading, checking, writing and documentation all
/// go through these members.
template <class Owner>
struct Key {
  KeyText text;
  bool is_section = false;  ///< written as tables of its own, after the plain keys
  std::function<void(const Value&, const std::string& path, Owner&, Mistakes&)> read;
  std::function<void(const Owner&, const std::string& path, Mistakes&)> check;
  std::function<std::string(const Owner&, const std::string& path)> write;
  std::function<void(const std::string& path, std::vector<TableText>&)> describe_below = nullptr;
};

/// One alternative of a std::variant in an Owner, such as a material law, with the keys it brings along.
template <class Owner>
struct Alternative {
  std::string keyword;
  std::string doc;
  std::vector<Key<Owner>> keys;
  std::function<void(Owner&)> choose;
};

template <class Owner>
struct Alternatives {
  std::string key;  ///< "law": its value is the keyword of the alternative
  std::string doc;
  std::vector<Alternative<Owner>> all;
  std::function<std::size_t(const Owner&)> chosen;

  [[nodiscard]] WordKind words() const {
    WordKind kind;
    for (const Alternative<Owner>& a : all) kind.words.push_back(a.keyword);
    return kind;
  }
};

/// A key that makes no sense beside another one.
struct Clash {
  std::string key;
  std::string with;
  std::string reason;
  std::string cure;
};

/// The keys of a table.
template <class Owner>
struct Schema {
  std::string doc = "";
  std::vector<Key<Owner>> keys;
  std::optional<Alternatives<Owner>> alternatives = std::nullopt;
  std::vector<std::vector<std::string>> one_of = {};  ///< exactly one key of each group must be given
  std::vector<Clash> clashes = {};
};

enum class Need { optional, required };
inline constexpr Need required = Need::required;

template <class Kind>
inline constexpr bool is_section_kind = requires {
  Kind::is_section;
};

/// An Owner with all its defaults. Not inlined: g++ 12 would warn of members that other Owners have.
template <class Owner>
[[gnu::noinline]] const Owner& untouched() {
  static const Owner owner{};
  return owner;
}

/// A key called `name` for what `get` (a member pointer or a function) finds in the Owner.
template <class Kind, class Get, class Owner>
Key<Owner> make_key(const std::string& name, Get get, Kind kind, const std::string& doc, Need need,
                    const std::string& example) {
  Key<Owner> out;
  out.text = {.name = name,
              .value = kind.describe(),
              .standard = "",
              .doc = doc,
              .example = example.empty() ? kind.example() : example,
              .required = need == Need::required};
  out.read = [get, kind](const Value& value, const std::string& path, Owner& owner, Mistakes& mistakes) {
    kind.read(value, path, std::invoke(get, owner), mistakes);
  };
  out.check = [get, kind](const Owner& owner, const std::string& path, Mistakes& mistakes) {
    kind.check(std::invoke(get, owner), path, mistakes);
  };
  if constexpr (is_section_kind<Kind>) {
    out.is_section = true;
    out.write = [get, kind](const Owner& owner, const std::string& path) {
      return kind.write(std::invoke(get, owner), path);
    };
  } else {
    out.write = [get, kind](const Owner& owner, const std::string&) { return kind.write(std::invoke(get, owner)); };
    if (!out.text.required) out.text.standard = kind.write(std::invoke(get, untouched<Owner>()));
  }
  if constexpr (requires(std::vector<TableText> & texts) { kind.describe_below(std::string(), texts); }) {
    out.describe_below = [kind](const std::string& path, std::vector<TableText>& texts) {
      kind.describe_below(path, texts);
    };
  }
  return out;
}

template <class Owner, class Member, class Kind>
Key<Owner> key(const std::string& name, Member Owner::*member, Kind kind, const std::string& doc, Need need = {},
               const std::string& example = "") {
  return make_key<Kind, Member Owner::*, Owner>(name, member, std::move(kind), doc, need, example);
}

/// The same for a part that no member pointer reaches; `get` takes `auto&` and returns `auto&`.
template <class Owner, class Get, class Kind>
Key<Owner> key_at(const std::string& name, Get get, Kind kind, const std::string& doc, Need need = {},
                  const std::string& example = "") {
  return make_key<Kind, Get, Owner>(name, get, std::move(kind), doc, need, example);
}

/// A key of a part of the Owner as a key of the Owner.
template <class Owner, class Part, class Get>
Key<Owner> lift(Key<Part> part, Get get) {
  Key<Owner> out{part.text, part.is_section, {}, {}, {}, part.describe_below};
  out.read = [part, get](const Value& value, const std::string& path, Owner& owner, Mistakes& mistakes) {
    part.read(value, path, get(owner), mistakes);
  };
  out.check = [part, get](const Owner& owner, const std::string& path, Mistakes& mistakes) {
    part.check(get(owner), path, mistakes);
  };
  out.write = [part, get](const Owner& owner, const std::string& path) { return part.write(get(owner), path); };
  return out;
}

/// The key of a parameter that a law, a shape or a mesh generator asks for.
template <class Owner>
Key<Owner> key_of_parameter(const Parameter<Owner>& p) {
  const Need need = p.required ? Need::required : Need::optional;
  const QuantityKind quantity{p.dimension, p.limits};
  struct Visitor {
    const Parameter<Owner>& p;
    const QuantityKind& quantity;
    Need need;
    Key<Owner> operator()(double Owner::*member) const { return key(p.name, member, quantity, p.doc, need, p.example); }
    Key<Owner> operator()(std::optional<double> Owner::*member) const {
      return key(p.name, member, QuantityOrWordKind{quantity, "none"}, p.doc, need, p.example);
    }
    Key<Owner> operator()(Vec2 Owner::*member) const { return key(p.name, member, VectorKind{quantity}, p.doc, need); }
    Key<Owner> operator()(std::optional<Vec2> Owner::*member) const {
      return key(p.name, member, VectorKind{quantity}, p.doc, need);
    }
    Key<Owner> operator()(std::vector<Vec2> Owner::*member) const {
      return key(p.name, member, PointsKind{quantity}, p.doc, need);
    }
    Key<Owner> operator()(const Choice<Owner>& choice) const {
      const WordKind kind{choice.words};
      const auto write = [choice, kind](const Owner& owner, const std::string&) {
        return kind.write(choice.get(owner));
      };
      Key<Owner> out;
      out.text = {p.name,
                  kind.describe(),
                  p.required ? "" : write(Owner{}, ""),
                  p.doc,
                  p.example.empty() ? kind.example() : p.example,
                  p.required};
      out.read = [choice, kind](const Value& value, const std::string& path, Owner& owner, Mistakes& mistakes) {
        if (const auto word = kind.read_word(value, path, mistakes)) choice.set(owner, *word);
      };
      out.check = [](const Owner&, const std::string&, Mistakes&) {};
      out.write = write;
      return out;
    }
  };
  return std::visit(Visitor{p, quantity, need}, p.member);
}

/// The alternatives of the variant that `get` finds in an Owner, each with its own parameters as keys.
template <class Owner, class Get, class... Types>
Alternatives<Owner> alternatives_of(std::string name, std::string doc, Get get, const std::variant<Types...>*) {
  Alternatives<Owner> out{
      std::move(name), std::move(doc), {}, [get](const Owner& o) { return std::invoke(get, o).index(); }};
  const auto add = [&]<class Type>(const Type*) {
    Alternative<Owner> one{
        Type::keyword, Type::doc, {}, [get](Owner& o) { std::invoke(get, o).template emplace<Type>(); }};
    const auto part = [get](auto& o) -> auto& { return std::get<Type>(std::invoke(get, o)); };
    for (const Parameter<Type>& p : Type::parameters()) one.keys.push_back(lift<Owner>(key_of_parameter(p), part));
    out.all.push_back(std::move(one));
  };
  (add(static_cast<const Types*>(nullptr)), ...);
  return out;
}

template <class Owner, class Variant>
Alternatives<Owner> alternatives(std::string name, std::string doc, Variant Owner::*member) {
  return alternatives_of<Owner>(std::move(name), std::move(doc), member, static_cast<const Variant*>(nullptr));
}

}  // namespace udar
