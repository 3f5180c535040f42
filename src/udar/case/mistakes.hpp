#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "udar/base/error.hpp"
#include "udar/case/document.hpp"

namespace udar {

/// Something wrong with a case, told by the path of its value. The same for a case file and for a case built in code:
/// only the first has places.
struct Mistake {
  std::string path;
  std::string message;
  std::string pointer;
  std::string cure;
  std::optional<Place> place = std::nullopt;  ///< none: looked up by the path
};

/// Collects mistakes, so that all are told at once.
class Mistakes {
 public:
  /// A mistake in what is written.
  void add(Mistake mistake);
  /// A mistake in what it means. Kept to itself where something at, above or below the path is wrong already: a value
  /// that could not be read is still at its default, and nothing should be said of that.
  void add_unless_touched(Mistake mistake);
  /// Nothing more is said of what lies at this path.
  void touch(std::string_view path) { touched_.emplace(path); }
  [[nodiscard]] bool touched(std::string_view path) const;

  [[nodiscard]] bool empty() const { return found_.empty(); }
  /// Enough for anyone: from here on only counted. Costly searches for a cure can be left out.
  [[nodiscard]] bool full() const { return found_.size() >= 1000; }

  /// In the order of the places, equal ones as one; without a document in the order found, each with its path.
  [[nodiscard]] std::vector<Diagnostic> diagnostics(const Document* document) const;

 private:
  std::vector<Mistake> found_;
  std::set<std::string, std::less<>> touched_;
  std::size_t left_out_ = 0;
};

}  // namespace udar
