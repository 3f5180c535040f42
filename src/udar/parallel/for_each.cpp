#include "udar/parallel/for_each.hpp"

#include <algorithm>
#include <chrono>
#include <string>
#include <system_error>

#include "udar/base/error.hpp"

namespace udar {
namespace {

constexpr std::uint64_t one_round = std::uint64_t{1} << 32;

bool is_open(std::uint64_t gate) { return (gate & one_round) != 0; }
std::uint64_t round_of(std::uint64_t gate) { return gate / one_round; }
std::uint64_t inside(std::uint64_t gate) { return gate % one_round; }

void relax() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

/// Spins until `ready`, for as long as what one thread does between two loops may take. Returns whether it came.
template <class Ready>
bool spin_until(Ready&& ready) {
  constexpr auto patience = std::chrono::microseconds(100);
  constexpr int between_looks_at_clock = 32;
  const auto begin = std::chrono::steady_clock::now();
  do {
    for (int i = 0; i < between_looks_at_clock; ++i) {
      if (ready()) return true;
      relax();
    }
  } while (std::chrono::steady_clock::now() - begin < patience);
  return false;
}

}  // namespace

int available_threads() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

Pool::Pool(int threads) : runs_(static_cast<std::size_t>(std::max(threads, 1))) {
  if (threads < 1) throw UserError(ExitCode::usage, "the number of threads must be 1 or more");
  try {
    for (std::size_t thread = 1; thread < runs_.size(); ++thread) workers_.emplace_back([=, this] { work(thread); });
  } catch (const std::system_error&) {
    go_home();
    throw UserError(ExitCode::resources, "the system gives no " + std::to_string(threads) + " threads",
                    "ask for fewer with --threads");
  }
}

Pool::~Pool() { go_home(); }

void Pool::go_home() {
  job_ = {};
  open_gate();
  for (std::thread& worker : workers_) worker.join();
}

void Pool::share_out(const Job& job) {
  job_ = job;
  for (Run& run : runs_) run.taken.store(false, std::memory_order_relaxed);
  open_gate();
  take_runs(0);
  close_gate();
  rethrow_first();
}

std::size_t Pool::begin_of(std::size_t blocks, std::size_t run) const {
  const std::size_t runs = runs_.size();
  return blocks / runs * run + blocks % runs * run / runs;  // blocks * run / runs, no overflow
}

std::size_t Pool::run_of(std::size_t blocks, std::size_t block) const {
  std::size_t run = 0;
  while (begin_of(blocks, run + 1) <= block) ++run;
  return run;
}

/// A thread's own run, if nobody has taken it, then those that wait for their threads.
void Pool::take_runs(std::size_t thread) {
  for (std::size_t k = 0; k < runs_.size(); ++k) {
    const std::size_t run = (thread + k) % runs_.size();
    // Relaxed: runs do not depend on each other, and the gate orders everything else.
    if (!runs_[run].taken.exchange(true, std::memory_order_relaxed)) do_run(run);
  }
}

void Pool::do_run(std::size_t run) {
  try {
    job_.run(job_.function, begin_of(job_.blocks, run), begin_of(job_.blocks, run + 1));
  } catch (...) {
    runs_[run].thrown = std::current_exception();
  }
}

void Pool::rethrow_first() {
  std::exception_ptr first;
  for (Run& run : runs_) {
    if (run.thrown && !first) first = run.thrown;
    run.thrown = nullptr;
  }
  if (first) std::rethrow_exception(first);
}

// Who goes to sleep first says so, then looks at the gate; who changes the gate looks for sleepers afterwards. All of
// these are sequentially consistent, so one of the two sees the other.

void Pool::open_gate() {
  gate_.fetch_add(one_round);
  if (asleep_.load() == 0) return;
  const std::lock_guard lock(bed_);
  wake_.notify_all();
}

/// All runs are taken; waits for those that workers are still at.
void Pool::close_gate() {
  gate_.fetch_add(one_round);
  const auto all_left = [&] { return inside(gate_.load()) == 0; };
  if (spin_until(all_left)) return;
  std::unique_lock lock(bed_);
  ++asleep_;
  wake_.wait(lock, all_left);
  --asleep_;
}

/// Waits for a round other than `round` and goes in, if it is still open then.
bool Pool::enter_gate(std::uint64_t& round) {
  const auto opened = [&] {
    const std::uint64_t gate = gate_.load();
    return is_open(gate) && round_of(gate) != round;
  };
  if (!spin_until(opened)) {
    std::unique_lock lock(bed_);
    ++asleep_;
    wake_.wait(lock, opened);
    --asleep_;
  }
  std::uint64_t gate = gate_.load();
  while (is_open(gate) && !gate_.compare_exchange_weak(gate, gate + 1)) {
  }
  round = round_of(gate);
  return is_open(gate);
}

void Pool::leave_gate() {
  const std::uint64_t before = gate_.fetch_sub(1);
  if (inside(before) != 1 || is_open(before) || asleep_.load() == 0) return;
  const std::lock_guard lock(bed_);
  wake_.notify_all();
}

void Pool::work(std::size_t thread) {
  std::uint64_t round = 0;
  while (true) {
    if (!enter_gate(round)) continue;
    if (job_.run == nullptr) return;
    take_runs(thread);
    leave_gate();
  }
}

}  // namespace udar
