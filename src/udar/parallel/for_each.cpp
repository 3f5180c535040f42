#include "udar/parallel/for_each.hpp"

#include <algorithm>
#include <string>
#include <system_error>

#include "udar/base/error.hpp"

namespace udar {
namespace {

void relax() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

/// Waits until `value` is no longer `old`. A few microseconds of spinning cover the gap between two loops of a step,
/// some hundred yields a core shared with another job; longer pauses (output, the end of the run) are slept through.
std::uint32_t wait_for_change(const std::atomic<std::uint32_t>& value, std::uint32_t old) {
  constexpr int spins = 500;
  constexpr int yields = 500;
  for (int i = 0; i < spins + yields; ++i) {
    const std::uint32_t now = value.load(std::memory_order_acquire);
    if (now != old) return now;
    if (i < spins) {
      relax();
    } else {
      std::this_thread::yield();
    }
  }
  value.wait(old, std::memory_order_acquire);
  return value.load(std::memory_order_acquire);
}

}  // namespace

int available_threads() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

Pool::Pool(int threads) {
  if (threads < 1) throw UserError(ExitCode::usage, "the number of threads must be 1 or more");
  thrown_.resize(static_cast<std::size_t>(threads));
  try {
    for (std::size_t thread = 1; thread < thrown_.size(); ++thread) workers_.emplace_back([=, this] { work(thread); });
  } catch (const std::system_error&) {
    go_home();
    throw UserError(ExitCode::resources, "the system gives no " + std::to_string(threads) + " threads",
                    "ask for fewer with --threads");
  }
}

Pool::~Pool() { go_home(); }

void Pool::go_home() {
  job_ = {};
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void Pool::share_out(const Job& job) {
  job_ = job;
  still_working_.store(static_cast<std::uint32_t>(workers_.size()), std::memory_order_relaxed);
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  run_share(0);
  std::uint32_t left = still_working_.load(std::memory_order_acquire);
  while (left != 0) left = wait_for_change(still_working_, left);

  std::exception_ptr first;
  for (std::exception_ptr& thrown : thrown_) {
    if (thrown && !first) first = thrown;
    thrown = nullptr;
  }
  if (first) std::rethrow_exception(first);
}

std::size_t Pool::begin_of(std::size_t blocks, std::size_t thread) const {
  const std::size_t threads = thrown_.size();
  return blocks / threads * thread + blocks % threads * thread / threads;  // blocks * thread / threads, no overflow
}

std::size_t Pool::thread_of(std::size_t blocks, std::size_t block) const {
  std::size_t thread = 0;
  while (begin_of(blocks, thread + 1) <= block) ++thread;
  return thread;
}

void Pool::run_share(std::size_t thread) {
  try {
    job_.run(job_.function, begin_of(job_.blocks, thread), begin_of(job_.blocks, thread + 1));
  } catch (...) {
    thrown_[thread] = std::current_exception();
  }
}

void Pool::work(std::size_t thread) {
  std::uint32_t round = 0;
  while (true) {
    // Every round is seen: the next one begins only when all have finished this one.
    round = wait_for_change(round_, round);
    if (job_.run == nullptr) return;
    run_share(thread);
    if (still_working_.fetch_sub(1, std::memory_order_acq_rel) == 1) still_working_.notify_one();
  }
}

}  // namespace udar
