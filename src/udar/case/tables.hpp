#pragma once

#include "udar/base/text.hpp"
#include "udar/case/schema.hpp"

namespace udar {

/// A key as the search for misspelt and missing keys sees it.
struct KnownKey {
  const KeyText* text;
  std::string elsewhere;  ///< `law = "tresca"` where the key belongs to another alternative and is refused here
};

/// Unknown, missing and excluding keys of a table.
void check_keys(const Value& table, const std::string& path, std::span<const KnownKey> known,
                std::span<const std::vector<std::string>> one_of, std::span<const Clash> clashes, Mistakes& mistakes);

/// The documentation of a key that chooses between alternatives.
template <class Owner>
KeyText choice_text(const Alternatives<Owner>& a) {
  const WordKind words = a.words();
  return {.name = a.key,
          .value = words.describe(),
          .standard = "",
          .doc = a.doc,
          .example = words.example(),
          .required = true};
}

template <class Owner>
void read_table(const Schema<Owner>& schema, const Value& table, const std::string& path, Owner& owner,
                Mistakes& mistakes) {
  if (table.kind != Value::Kind::table) return wrong_kind(table, path, "a table", "", mistakes);

  std::vector<KnownKey> known;
  std::vector<const Key<Owner>*> readable;
  const auto take = [&](const Key<Owner>& key) {
    known.push_back({&key.text, ""});
    readable.push_back(&key);
  };
  for (const Key<Owner>& key : schema.keys) take(key);

  std::optional<int> choice;
  KeyText choice_key;
  std::vector<KeyText> unclear;
  if (schema.alternatives) {
    const Alternatives<Owner>& a = *schema.alternatives;
    choice_key = choice_text(a);
    known.push_back({&choice_key, ""});
    if (const Entry* entry = table.find(a.key)) choice = a.words().read_word(entry->value, join(path, a.key), mistakes);
    if (choice) a.all[static_cast<std::size_t>(*choice)].choose(owner);
    for (std::size_t i = 0; i < a.all.size(); ++i) {
      for (const Key<Owner>& key : a.all[i].keys) {
        if (choice && static_cast<int>(i) == *choice) {
          take(key);
        } else if (choice) {
          known.push_back({&key.text, a.key + " = " + toml_text(a.all[i].keyword)});
        } else {
          unclear.push_back(key.text);
          unclear.back().required = false;
        }
      }
    }
  }
  for (const KeyText& text : unclear) known.push_back({&text, ""});

  for (const Key<Owner>* key : readable) {
    if (const Entry* entry = table.find(key->text.name))
      key->read(entry->value, join(path, key->text.name), owner, mistakes);
  }
  if (schema.alternatives && !choice) mistakes.touch(join(path, schema.alternatives->key));
  check_keys(table, path, known, schema.one_of, schema.clashes, mistakes);
}

/// Limits of all values, however they came there.
template <class Owner>
void check_table(const Schema<Owner>& schema, const Owner& owner, const std::string& path, Mistakes& mistakes) {
  for (const Key<Owner>& key : schema.keys) key.check(owner, join(path, key.text.name), mistakes);
  if (!schema.alternatives || mistakes.touched(join(path, schema.alternatives->key))) return;
  const auto& chosen = schema.alternatives->all[schema.alternatives->chosen(owner)];
  for (const Key<Owner>& key : chosen.keys) key.check(owner, join(path, key.text.name), mistakes);
}

/// Calls `visit(name, text)` for every plain key that has something to say.
template <class Owner, class Visit>
void write_plain_keys(const Schema<Owner>& schema, const Owner& owner, const std::string& path, Visit visit) {
  const auto write = [&](const Key<Owner>& key) {
    if (key.is_section) return;
    const std::string text = key.write(owner, join(path, key.text.name));
    if (!text.empty()) visit(key.text.name, text);
  };
  if (schema.alternatives) {
    const auto& chosen = schema.alternatives->all[schema.alternatives->chosen(owner)];
    visit(schema.alternatives->key, toml_text(chosen.keyword));
    for (const Key<Owner>& key : chosen.keys) write(key);
  }
  for (const Key<Owner>& key : schema.keys) write(key);
}

template <class Owner>
std::string write_inline(const Schema<Owner>& schema, const Owner& owner) {
  std::string out;
  write_plain_keys(schema, owner, "", [&](const std::string& name, const std::string& text) {
    out += (out.empty() ? "" : ", ") + name + " = " + text;
  });
  return "{ " + out + " }";
}

template <class Owner>
std::string write_section(const Schema<Owner>& schema, const Owner& owner, const std::string& path,
                          const std::string& header) {
  std::string lines;
  write_plain_keys(schema, owner, path,
                   [&](const std::string& name, const std::string& text) { lines += name + " = " + text + "\n"; });
  std::string out = lines.empty() || header.empty() ? lines : header + "\n" + lines + "\n";
  for (const Key<Owner>& key : schema.keys) {
    if (key.is_section) out += key.write(owner, join(path, key.text.name));
  }
  return out;
}

/// `header` as in TableText; tables inside follow.
template <class Owner>
void describe_table(const Schema<Owner>& schema, const std::string& path, const std::string& header,
                    std::vector<TableText>& texts) {
  TableText table{header, path, schema.doc, {}, {}};
  for (const auto& group : schema.one_of) table.doc += " Exactly one of " + one_of(group) + " is given.";
  if (schema.alternatives) table.keys.push_back(choice_text(*schema.alternatives));
  for (const Key<Owner>& key : schema.keys) {
    if (!key.is_section) table.keys.push_back(key.text);
  }
  if (schema.alternatives) {
    for (const Alternative<Owner>& a : schema.alternatives->all) {
      ChoiceText choice{schema.alternatives->key + " = " + toml_text(a.keyword), a.doc, {}};
      for (const Key<Owner>& key : a.keys) choice.keys.push_back(key.text);
      table.choices.push_back(std::move(choice));
    }
  }
  if (!table.keys.empty()) texts.push_back(std::move(table));
  for (const Key<Owner>& key : schema.keys) {
    if (key.describe_below) key.describe_below(join(path, key.text.name), texts);
  }
}

/// What the required keys of a table look like, in one line.
template <class Owner>
std::string inline_example(const Schema<Owner>& schema) {
  std::string out;
  const auto show = [&](const KeyText& text) { out += (out.empty() ? "" : ", ") + text.name + " = " + text.example; };
  if (schema.alternatives) {
    show(choice_text(*schema.alternatives));
    for (const Key<Owner>& key : schema.alternatives->all.front().keys) {
      if (key.text.required) show(key.text);
    }
  }
  for (const Key<Owner>& key : schema.keys) {
    if (key.text.required) show(key.text);
  }
  return "{ " + out + " }";
}

template <class Owner>
using SchemaSource = const Schema<Owner>& (*)();

/// A table written in one line: mesh = { shape = "rectangle", ... }.
template <class Owner>
struct InlineTableKind {
  SchemaSource<Owner> schema;

  [[nodiscard]] std::string describe() const { return "table, see below"; }
  [[nodiscard]] std::string example() const { return inline_example(schema()); }
  void read(const Value& value, const std::string& path, Owner& out, Mistakes& mistakes) const {
    read_table(schema(), value, path, out, mistakes);
  }
  void read(const Value& value, const std::string& path, std::optional<Owner>& out, Mistakes& mistakes) const {
    read_table(schema(), value, path, out.emplace(), mistakes);
  }
  void check(const Owner& value, const std::string& path, Mistakes& mistakes) const {
    check_table(schema(), value, path, mistakes);
  }
  void check(const std::optional<Owner>& value, const std::string& path, Mistakes& mistakes) const {
    if (value) check_table(schema(), *value, path, mistakes);
  }
  [[nodiscard]] std::string write(const Owner& value) const { return write_inline(schema(), value); }
  [[nodiscard]] std::string write(const std::optional<Owner>& value) const { return value ? write(*value) : ""; }
  void describe_below(const std::string& path, std::vector<TableText>& texts) const {
    const auto dot = path.rfind('.');
    const std::string header = path.substr(dot + 1) + " = { ... } in [" + path.substr(0, dot) + "]";
    describe_table(schema(), path, header, texts);
  }
};

/// A table with a header: [run].
template <class Owner>
struct SectionKind {
  static constexpr bool is_section = true;
  SchemaSource<Owner> schema;

  [[nodiscard]] std::string describe() const { return "table"; }
  [[nodiscard]] std::string example() const { return ""; }
  void read(const Value& value, const std::string& path, Owner& out, Mistakes& mistakes) const {
    read_table(schema(), value, path, out, mistakes);
  }
  void check(const Owner& value, const std::string& path, Mistakes& mistakes) const {
    check_table(schema(), value, path, mistakes);
  }
  [[nodiscard]] std::string write(const Owner& value, const std::string& path) const {
    return write_section(schema(), value, path, "[" + path + "]");
  }
  void describe_below(const std::string& path, std::vector<TableText>& texts) const {
    describe_table(schema(), path, "[" + path + "]", texts);
  }
};

/// Tables by name: [bodies.beam], [bodies.plate].
template <class Item>
struct NamedKind {
  static constexpr bool is_section = true;
  SchemaSource<Item> schema;

  [[nodiscard]] std::string describe() const { return "tables by name"; }
  [[nodiscard]] std::string example() const { return ""; }
  void read(const Value& value, const std::string& path, std::vector<Item>& out, Mistakes& mistakes) const {
    if (value.kind != Value::Kind::table)
      return wrong_kind(value, path, "a table for each, [" + path + ".NAME],", "", mistakes);
    for (const Entry& entry : value.entries) {
      const std::string item_path = join(path, entry.key);
      out.emplace_back().name = entry.key;
      if (!check_name(entry.key, item_path, mistakes, entry.place)) continue;
      if (entry.value.kind != Value::Kind::table) {
        wrong_kind(entry.value, item_path, "a table for each, [" + path + ".NAME],", "", mistakes);
      } else {
        read_table(schema(), entry.value, item_path, out.back(), mistakes);
      }
    }
  }
  void check(const std::vector<Item>& value, const std::string& path, Mistakes& mistakes) const {
    for (const Item& item : value) {
      check_name(item.name, join(path, item.name), mistakes);
      check_table(schema(), item, join(path, item.name), mistakes);
    }
  }
  [[nodiscard]] std::string write(const std::vector<Item>& value, const std::string& path) const {
    std::string out;
    for (const Item& item : value) {
      const std::string item_path = join(path, item.name);
      out += write_section(schema(), item, item_path, "[" + item_path + "]");
    }
    return out;
  }
  void describe_below(const std::string& path, std::vector<TableText>& texts) const {
    describe_table(schema(), path + ".NAME", "[" + path + ".NAME]", texts);
  }
};

/// Tables in a list: [[observe.nodes]], as often as wanted.
template <class Item>
struct ListedKind {
  static constexpr bool is_section = true;
  SchemaSource<Item> schema;

  [[nodiscard]] std::string describe() const { return "tables"; }
  [[nodiscard]] std::string example() const { return ""; }
  void read(const Value& value, const std::string& path, std::vector<Item>& out, Mistakes& mistakes) const {
    if (value.kind != Value::Kind::list)
      return wrong_kind(value, path, "a list of tables", "[[" + path + "]]", mistakes);
    for (std::size_t i = 0; i < value.items.size(); ++i) {
      read_table(schema(), value.items[i], join(path, std::to_string(i)), out.emplace_back(), mistakes);
    }
  }
  void check(const std::vector<Item>& value, const std::string& path, Mistakes& mistakes) const {
    for (std::size_t i = 0; i < value.size(); ++i)
      check_table(schema(), value[i], join(path, std::to_string(i)), mistakes);
  }
  [[nodiscard]] std::string write(const std::vector<Item>& value, const std::string& path) const {
    std::string out;
    for (const Item& item : value) out += write_section(schema(), item, path, "[[" + path + "]]");
    return out;
  }
  void describe_below(const std::string& path, std::vector<TableText>& texts) const {
    describe_table(schema(), path, "[[" + path + "]]", texts);
  }
};

}  // namespace udar
