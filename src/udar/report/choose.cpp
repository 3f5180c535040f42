#include "udar/report/choose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "udar/report/quantities.hpp"

namespace udar {

bool Choice::has(std::string_view word) const { return std::find(words.begin(), words.end(), word) != words.end(); }

std::vector<std::size_t> chosen_frames(std::size_t total, std::size_t every) {
  std::vector<std::size_t> chosen;
  if (total == 0 || every == 0) return chosen;
  for (std::size_t frame = 0; frame + 1 < total; frame += every) chosen.push_back(frame);
  chosen.push_back(total - 1);
  return chosen;
}

std::size_t every_for(std::size_t total, std::size_t most) {
  if (total <= most || most < 2) return 1;
  return (total - 1 + most - 2) / (most - 1);
}

Ladder::Ladder(Choice begin, std::size_t frames, std::vector<std::string> keep)
    : begin_(begin), choice_(std::move(begin)), frames_(frames), keep_(std::move(keep)) {}

bool Ladder::drop(std::string_view word) {
  if (std::find(keep_.begin(), keep_.end(), word) != keep_.end()) return false;
  if (word == contact_force_word) return std::exchange(choice_.forces, false);
  return std::erase(choice_.words, word) > 0;
}

bool Ladder::fewer_bits(int bits) {
  if (choice_.bits <= bits) return false;
  choice_.bits = bits;
  return true;
}

bool Ladder::fewer_frames() {
  if (choice_.every == 0) return false;
  // Of the first and the last frame alone nothing can be left out but both.
  choice_.every = choice_.every + 1 < frames_ ? 2 * choice_.every : 0;
  return true;
}

bool Ladder::step() {
  if (drop("acceleration") || fewer_bits(10) || drop("velocity") || fewer_bits(8)) return true;
  if (choice_.every == begin_.every) return fewer_frames();
  return drop(contact_force_word) || drop("principal_2") || fewer_frames();
}

std::vector<std::string> Ladder::sentences() const {
  std::vector<std::string> out;
  const auto lost = [&](std::string_view word, std::string_view name) {
    if (begin_.has(word) && !choice_.has(word)) out.push_back(fmt::format("{} left out: they are in fields/", name));
  };
  lost("acceleration", "accelerations are");
  lost("velocity", "velocities are");
  if (begin_.forces && !choice_.forces) out.emplace_back("contact forces are left out: they are in fields/");
  if (begin_.has("principal_2") && !choice_.has("principal_2")) {
    out.emplace_back("the second principal stress is left out: it is in fields/");
  }
  if (choice_.bits < begin_.bits) {
    out.push_back(fmt::format("fields are stored to 1/{} of their range", (1 << choice_.bits) - 1));
  }
  if (choice_.every == 0 && frames_ > 0) {
    out.push_back(fmt::format("none of {} frames is here: they are in fields/", frames_));
  } else if (choice_.every > 1) {
    out.push_back(choice_.every + 1 >= frames_
                      ? fmt::format("only the first and the last of {} frames are here", frames_)
                      : fmt::format("every {} of {} frames is here", ordinal(choice_.every), frames_));
  }
  return out;
}

std::string ordinal(std::size_t number) {
  const std::size_t last = number % 10;
  const bool teen = number / 10 % 10 == 1;
  const char* ending = teen || last == 0 || last > 3 ? "th" : last == 1 ? "st" : last == 2 ? "nd" : "rd";
  return fmt::format("{}{}", number, ending);
}

}  // namespace udar
