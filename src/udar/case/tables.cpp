#include "udar/case/tables.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "udar/base/text.hpp"
#include "udar/case/ascii.hpp"

namespace udar {
namespace {

Mistake unknown_key(const Entry& entry, const std::string& path, std::span<const KnownKey> known, std::string& meant) {
  Mistake m{path, fmt::format("unknown key `{}`", shown(entry.key)), "", "", entry.place};
  std::vector<std::string> names;
  for (const KnownKey& k : known) {
    if (k.elsewhere.empty()) names.push_back(k.text->name);
    if (k.text->name != entry.key) continue;
    m.message = fmt::format("key `{}` is of no use here", entry.key);
    m.pointer = fmt::format("it belongs to {}", k.elsewhere);
    m.cure = fmt::format("leave it out or choose {}", k.elsewhere);
    return m;
  }
  meant = nearest_word(entry.key, names);
  m.cure = meant.empty() ? fmt::format("known here: {}", one_of(names)) : fmt::format("did you mean `{}`?", meant);
  return m;
}

void check_group(const Value& table, const std::string& path, const std::vector<std::string>& group,
                 Mistakes& mistakes) {
  const Entry* first = nullptr;
  bool misspelt = false;
  for (const std::string& name : group) {
    const Entry* entry = table.find(name);
    misspelt = misspelt || (entry == nullptr && mistakes.touched(join(path, name)));
    if (entry == nullptr) continue;
    if (first != nullptr) {
      mistakes.add({join(path, name), fmt::format("`{}` and `{}` exclude each other", first->key, name),
                    "this is the second one", fmt::format("give one of {}", one_of(group)), entry->place});
    }
    first = entry;
  }
  if (first == nullptr && !misspelt) {
    mistakes.add({path, fmt::format("one of {} is missing", one_of(group)), "it is needed here", "", table.place});
  }
}

}  // namespace

void check_keys(const Value& table, const std::string& path, std::span<const KnownKey> known,
                std::span<const std::vector<std::string>> one_of_groups, std::span<const Clash> clashes,
                Mistakes& mistakes) {
  std::set<std::string, std::less<>> allowed;
  for (const KnownKey& k : known) {
    if (k.elsewhere.empty()) allowed.insert(k.text->name);
  }
  std::set<std::string, std::less<>> meant;  // a required key that was only misspelt is not missing as well
  for (const Entry& entry : table.entries) {
    if (allowed.contains(entry.key)) continue;
    const std::string entry_path = join(path, entry.key);
    if (mistakes.full()) {
      mistakes.add({entry_path, "unknown key", "", "", entry.place});
      continue;
    }
    std::string near;
    mistakes.add(unknown_key(entry, entry_path, known, near));
    if (near.empty() || table.find(near) != nullptr) continue;
    mistakes.touch(join(path, near));
    meant.insert(near);
  }
  for (const KnownKey& k : known) {
    const KeyText& text = *k.text;
    if (!text.required || !k.elsewhere.empty() || table.find(text.name) != nullptr || meant.contains(text.name))
      continue;
    const std::string add = text.example.empty() ? fmt::format("add a table [{}]", join(path, text.name))
                                                 : fmt::format("add {} = {}", text.name, text.example);
    Mistake m{join(path, text.name), fmt::format("missing key `{}`", text.name), text.value + " is needed here", add};
    if (text.example.empty()) m.message = fmt::format("missing table [{}]", join(path, text.name));
    if (table.place.line > 0) m.place = table.place;
    mistakes.add(std::move(m));
  }
  for (const auto& group : one_of_groups) check_group(table, path, group, mistakes);
  for (const Clash& clash : clashes) {
    const Entry* entry = table.find(clash.key);
    if (entry == nullptr || table.find(clash.with) == nullptr) continue;
    mistakes.add({join(path, clash.key), fmt::format("`{}` does not go with `{}`", clash.key, clash.with), clash.reason,
                  clash.cure, entry->place});
  }
}

}  // namespace udar
