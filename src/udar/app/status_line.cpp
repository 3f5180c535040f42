#include "udar/app/status_line.hpp"

#include <cmath>

#include "udar/app/terminal.hpp"
#include "udar/output/summarise.hpp"

namespace udar {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

}  // namespace

StatusLine::StatusLine(double end_time)
    : terminal_(is_terminal()), unit_(unit_for(end_time)), begin_(steady_clock::now()) {
  next_ = begin_ + (terminal_ ? milliseconds(200) : milliseconds(5000));
}

StatusLine::TimeUnit StatusLine::unit_for(double time) {
  if (time >= 1) return {"s", 1};
  if (time >= 1e-3) return {"ms", 1e3};
  return time >= 1e-6 ? TimeUnit{"us", 1e6} : TimeUnit{"ns", 1e9};
}

void StatusLine::update(const Model& model, const State& state) {
  constexpr std::uint64_t look_every = 16;
  if (state.clock.step % look_every != 0 || steady_clock::now() < next_) return;
  next_ = steady_clock::now() + (terminal_ ? milliseconds(250) : milliseconds(10000));
  const double done = state.clock.time.value() / model.run.end_time;
  const double spent = std::chrono::duration<double>(steady_clock::now() - begin_).count();
  print(model, state, done > 0 ? clock_text(spent * (1 - done) / done) : "--:--");
}

void StatusLine::finish(const Model& model, const State& state) {
  print(model, state, "00:00");
  if (terminal_) say("\n");
}

void StatusLine::print(const Model& model, const State& state, const std::string& left) {
  const Clock& clock = state.clock;
  if (!headed_) {
    headed_ = true;
    step_unit_ = unit_for(clock.next_step);
    say("{:>9} {:>9} {:>4}  {:<6} {:>7}  {:<25} {:>10} {:>9}\n", "step", fmt::format("t/{}", unit_.name), "%", "ETA",
        fmt::format("dt/{}", step_unit_.name), "limited by", "energy err", "contacts");
  }
  std::uint64_t contacts = 0;
  for (const ContactBook& obstacle : state.obstacles) contacts += obstacle.touching;
  for (const PairBook& pair : state.pairs) contacts += pair.book.touching;
  say_in_place(fmt::format("{:>9} {:>9.4f} {:>4.0f}  {:<6} {:>7.4g}  {:<25} {:>8.2g} % {:>9}", clock.step,
                           unit_.per_second * clock.time.value(),
                           std::floor(100 * clock.time.value() / model.run.end_time), left,
                           step_unit_.per_second * clock.last_step,
                           element_name(model, clock.limit.element) + (clock.limit.by_contact != 0 ? " + contact" : ""),
                           100 * state.ledger.energy_error(), contacts));
}

}  // namespace udar
