#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace udar {

/// What of a run goes into its report.
struct Choice {
  std::vector<std::string> words;  ///< quantities as a user calls them; places are always there
  bool forces = true;              ///< of contact
  int bits = 12;                   ///< of fields; places and yes or no have their own
  std::size_t every = 1;           ///< every so many frames, and the last; 0: none

  [[nodiscard]] bool has(std::string_view word) const;
};

/// The frames of `total` that a choice keeps: the first, every so many, and the last.
std::vector<std::size_t> chosen_frames(std::size_t total, std::size_t every);
/// The smallest `every` that leaves at most `most` frames (2 or more).
std::size_t every_for(std::size_t total, std::size_t most);

/// What a report goes without to fit into its limit, one thing after the other.
class Ladder {
 public:
  /// `keep`: these quantities were asked for and are never left out.
  Ladder(Choice begin, std::size_t frames, std::vector<std::string> keep);

  [[nodiscard]] const Choice& choice() const { return choice_; }
  /// Goes without the next thing. False: there is nothing left.
  bool step();
  /// What the choice has cost, a sentence each.
  [[nodiscard]] std::vector<std::string> sentences() const;

 private:
  bool drop(std::string_view word);
  bool fewer_bits(int bits);
  bool fewer_frames();

  Choice begin_;
  Choice choice_;
  std::size_t frames_;
  std::vector<std::string> keep_;
};

/// "4th", "22nd".
std::string ordinal(std::size_t number);

}  // namespace udar
