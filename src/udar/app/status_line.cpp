#include "udar/app/status_line.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>

#include "udar/output/summarise.hpp"

namespace udar {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

std::string minutes(double seconds) {
  const auto whole = static_cast<long long>(seconds + 0.5);
  if (whole >= 3600) return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
  return fmt::format("{:02}:{:02}", whole / 60, whole % 60);
}

}  // namespace

StatusLine::StatusLine() : terminal_(isatty(STDOUT_FILENO) == 1), begin_(steady_clock::now()) {
  next_ = begin_ + (terminal_ ? milliseconds(200) : milliseconds(5000));
}

void StatusLine::update(const Model& model, const State& state) {
  constexpr std::uint64_t look_every = 16;
  if (state.clock.step % look_every != 0 || steady_clock::now() < next_) return;
  next_ = steady_clock::now() + (terminal_ ? milliseconds(250) : milliseconds(10000));
  print(model, state);
}

void StatusLine::finish(const Model& model, const State& state) {
  print(model, state);
  if (terminal_) fmt::print("\n");
}

void StatusLine::print(const Model& model, const State& state) {
  if (!headed_) {
    fmt::print("{:>8}  {:>9} {:>4} {:>6} {:>8}  {:<28} {:>10} {:>9}\n", "step", "t/ms", "%", "ETA", "dt/ns",
               "limited by", "energy err", "contacts");
    headed_ = true;
  }
  const Clock& clock = state.clock;
  const double done = clock.time.value() / model.run.end_time;
  const double spent = std::chrono::duration<double>(steady_clock::now() - begin_).count();
  std::uint64_t contacts = 0;
  for (const ObstacleBook& obstacle : state.obstacles) contacts += obstacle.touching;
  fmt::print("{}{:>8}  {:>9.4f} {:>4.0f} {:>6} {:>8.1f}  {:<28} {:>8.4f} % {:>9}{}", terminal_ ? "\r" : "", clock.step,
             1e3 * clock.time.value(), 100 * done, done > 0 ? minutes(spent * (1 - done) / done) : "--:--",
             1e9 * clock.last_step,
             element_name(model, clock.limit.element) + (clock.limit.by_contact != 0 ? " + contact" : ""),
             100 * state.ledger.energy_error(), contacts, terminal_ ? "\x1b[K" : "\n");
  std::fflush(stdout);
}

}  // namespace udar
