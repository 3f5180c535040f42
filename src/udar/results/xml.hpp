#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace udar {

/// `text` as it may stand between tags or in a quoted attribute: markup escaped, control bytes and bytes that are not
/// UTF-8 replaced by `?`, so that no name a user chose can break the file or slip in markup.
std::string escape_xml(std::string_view text);

/// One tag: `<name a="1">`, `</name>` (closing) or `<name/>`.
struct XmlTag {
  std::string name;
  bool closing = false;
  std::map<std::string, std::string, std::less<>> attributes;

  /// The attribute called `key`, or "".
  [[nodiscard]] std::string attribute(std::string_view key) const;
  /// The attribute as a whole number >= 0; none where it is missing or is anything else.
  [[nodiscard]] std::optional<std::size_t> count(std::string_view key) const;
};

/// Goes through the tags of XML text as Udar writes it; text between tags, `<?...?>` and comments are skipped.
class XmlScanner {
 public:
  explicit XmlScanner(std::string_view text) : text_(text) {}
  /// The next tag; none at the end. Throws OutputError where a tag is broken.
  std::optional<XmlTag> next();
  /// Just behind the last tag.
  [[nodiscard]] std::size_t position() const { return position_; }

 private:
  std::string_view text_;
  std::size_t position_ = 0;
};

}  // namespace udar
