#pragma once

#include <memory>
#include <string>
#include <vector>

#include "udar/app/commands.hpp"

namespace udar {

/// What a command line says, before anything is done. Exactly one of the three is there.
struct Reading {
  const Command* command = nullptr;  ///< what is to be run
  std::string answer;                ///< the help or the version that was asked for
  std::string mistake;               ///< what is wrong with the words, as the user reads it
};

/// The words that the program understands: all its commands and their options.
class CommandLine {
 public:
  CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;
  ~CommandLine();

  /// Reads the words behind the name of the program. Does nothing else: no file is touched, nothing is written. Values
  /// of options such as times are read when the command runs.
  Reading read(std::vector<std::string> words);

 private:
  std::unique_ptr<CLI::App> app_;
  std::vector<Command> commands_;
};

}  // namespace udar
