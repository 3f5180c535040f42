#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "udar/report/arrays.hpp"

namespace udar {

using Json = nlohmann::ordered_json;

/// The arrays of a report, in the order of their blocks.
class Blocks {
 public:
  /// Takes an array; gives its description.
  Json add(PackedArray array);
  /// Forgets all but the first `count`.
  void cut(std::size_t count);
  [[nodiscard]] std::size_t count() const { return texts_.size(); }
  /// Bytes that they take in the file.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }
  [[nodiscard]] const std::vector<std::string>& texts() const { return texts_; }

 private:
  [[nodiscard]] std::size_t bytes_of(std::size_t block) const;

  std::vector<std::string> texts_;
  std::size_t bytes_ = 0;
};

/// Bytes of an element that holds so many, whichever number it gets.
std::size_t block_bytes(std::size_t text_bytes);

/// JSON as it may stand in a script element: no name that a user chose can end it.
std::string safe_json(const Json& json);

/// Gives the file to `take`, piece by piece; `run` is the description as `safe_json` makes it. Throws OutputError where
/// `page` has no place for a run, or several.
void compose(std::string_view page, std::string_view run, const Blocks& blocks,
             const std::function<void(std::string_view)>& take);
/// Bytes of a file that holds nothing: what `page` itself takes. Throws as `compose`.
std::size_t page_bytes(std::string_view page);
/// Writes the file, all or nothing; gives its bytes. Throws OutputError.
std::size_t write_page(const std::filesystem::path& path, std::string_view page, std::string_view run,
                       const Blocks& blocks);

/// "25 MB".
std::string megabytes(std::size_t bytes);

}  // namespace udar
