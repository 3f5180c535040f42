#include "udar/app/signals.hpp"

#include <csignal>
#include <ctime>

namespace udar {
namespace {

volatile std::sig_atomic_t caught_signal = 0;
volatile std::sig_atomic_t caught_at = 0;  // s

extern "C" void note_signal(int signal) {
  // Some tools send a signal to a process and again to its group: only one that comes later ends the program at once.
  const auto now = static_cast<std::sig_atomic_t>(std::time(nullptr));
  if (caught_signal != 0 && now > caught_at + 1) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
  if (caught_signal != 0) return;
  caught_signal = signal;
  caught_at = now;
}

}  // namespace

void catch_signals() {
  std::signal(SIGINT, note_signal);
  std::signal(SIGTERM, note_signal);
  // Under `nohup` it is ignored, and stays so.
  if (std::signal(SIGHUP, note_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
}

bool is_interrupted() { return caught_signal != 0; }

OnlyNewSignals::OnlyNewSignals() : before_(caught_signal) { caught_signal = 0; }

OnlyNewSignals::~OnlyNewSignals() {
  if (caught_signal == 0) caught_signal = before_;
}

ExitCode code_of_signal() {
  if (caught_signal == SIGHUP) return ExitCode::hung_up;
  return caught_signal == SIGTERM ? ExitCode::terminated : ExitCode::interrupted;
}

}  // namespace udar
