#include "udar/app/command_line.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "fuzz/target.hpp"
#include "udar/app/picture_options.hpp"
#include "udar/base/error.hpp"
#include "udar/case/case_file.hpp"
#include "udar/case/document.hpp"
#include "udar/case/reference.hpp"
#include "udar/study/plan.hpp"

using namespace udar;

namespace {

/// Words, one on each line.
std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  while (!text.empty() && words.size() < 64) {
    const std::size_t end = text.find('\n');
    words.emplace_back(text.substr(0, end));
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
  }
  return words;
}

/// Calls what reads the value of an option, which may refuse it with a message only.
template <class Read>
void attempt(Read read) {
  try {
    read();
  } catch (const UserError& error) {
    fuzz::require(!error.diagnostics.empty() && error.what()[0] != '\0');
  }
}

/// Carries an assignment out; with one of 32 the case is read, which takes much longer.
void assign_value(const std::string& value) {
  static const Document plain = *parse_document(example_case(), "fuzz.toml");
  Document document = plain;
  const auto done = assign(document, value);
  if (!done) fuzz::require(!done.error().message.empty());
  if (!done || std::hash<std::string>{}(value) % 32 != 0) return;
  const std::vector<std::string> assignments{value};
  attempt([&] { check_case(read_case(example_case(), "fuzz.toml", assignments)); });
}

void read_option(std::string_view option, const std::string& value) {
  if (option == "--set") {
    assign_value(value);
  } else if (option == "--vary") {
    attempt([&] {
      const Variation v = read_variation(value);
      fuzz::require(!v.path.empty() && !v.values.empty() && v.values.size() <= value.size() + 10001);
    });
  } else if (option == "--limit") {
    attempt([&] { fuzz::require(size_of_option(option, value) >= 1); });
  } else if (option == "--times") {
    for (const std::string& time : split_list(value, ',')) attempt([&] { time_of_option(option, time); });
  } else {
    PictureArguments picture;
    if (option == "--field") picture.field = value;
    if (option == "--range") picture.range = value;
    if (option == "--unit") picture.unit = value;
    if (option == "--view") picture.view = value;
    attempt([&] { frame_view(picture, "no-such-run"); });
  }
}

}  // namespace

/// Each line is a word of the command line. The words of an option that commands read by themselves are read, too;
/// nothing is run.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static CommandLine line;  // to make one takes longer than to use it
  std::vector<std::string> words = words_of(fuzz::text_of(data, size));
  for (std::size_t k = 0; k + 1 < words.size(); ++k) {
    if (words[k].starts_with("--")) read_option(words[k], words[k + 1]);
  }
  const Reading reading = line.read(std::move(words));
  const int said = int(reading.command != nullptr) + int(!reading.answer.empty()) + int(!reading.mistake.empty());
  fuzz::require(said == 1);
  return 0;
}
