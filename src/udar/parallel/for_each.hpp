#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <type_traits>
#include <vector>

namespace udar {

/// Threads that the machine runs at once; at least 1.
int available_threads();

/// Threads that share out the blocks of a loop: as many runs of neighbours as there are threads. Every thread takes its
/// own run, always the same one, so that its data stay in its caches. The run of a thread that does not come, since the
/// system has put it aside for another job, is taken by who is done: nobody waits but for a thread that is at work.
///
/// Between two loops threads spin for a moment, then sleep: a pure spin barrier collapses when another job shares the
/// cores, and sleeping at once costs more than a small loop. They never yield (as std::atomic::wait does): Linux lets a
/// thread that yields beside another job wait for milliseconds, hundreds of times as long as a loop takes.
///
/// Sums over blocks: let every block write its own partial sum and add those up in the order of the blocks after the
/// loop. The result then has the same bits for any number of threads.
class Pool {
 public:
  /// `threads` counts the caller too; with 1 everything runs inline. Throws UserError(usage) below 1, and
  /// UserError(resources) where the system gives no more threads.
  explicit Pool(int threads);
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  [[nodiscard]] int threads() const { return static_cast<int>(workers_.size()) + 1; }

  /// Calls f(block) for every block in 0 .. blocks - 1; those of one run (`run_of`) one after another, by one thread.
  /// Returns when all are done. What f throws is thrown here (of several, that of the lowest run); the rest of a run
  /// that threw is left out. Not to be called from within f, nor from two threads at once. Allocates nothing.
  template <class F>
  void for_each_block(std::size_t blocks, F&& f) {
    for_each_run(blocks, [&](std::size_t begin, std::size_t end) {
      for (std::size_t block = begin; block < end; ++block) f(block);
    });
  }

  /// The same, with f(begin, end) called once for each run of neighbours that is not empty.
  template <class F>
  void for_each_run(std::size_t blocks, F&& f) {
    if (blocks == 0) return;
    if (workers_.empty()) return f(0, blocks);
    using Function = std::remove_reference_t<F>;
    const auto run = [](void* function, std::size_t begin, std::size_t end) {
      if (begin < end) (*static_cast<Function*>(function))(begin, end);
    };
    share_out({run, const_cast<void*>(static_cast<const void*>(std::addressof(f))), blocks});
  }

  /// Calls f(job) for every job in 0 .. jobs - 1, which may differ in length: each thread takes the next one that
  /// nobody has. What f throws is thrown here; the rest may be left out.
  template <class F>
  void for_each_job(std::size_t jobs, F&& f) {
    std::atomic<std::size_t> next{0};
    for_each_run(static_cast<std::size_t>(threads()), [&](std::size_t, std::size_t) {
      for (std::size_t job = 0; (job = next.fetch_add(1, std::memory_order_relaxed)) < jobs;) f(job);
    });
  }

  /// Which run has a block of so many.
  [[nodiscard]] std::size_t run_of(std::size_t blocks, std::size_t block) const;

 private:
  struct Job {
    void (*run)(void* function, std::size_t begin, std::size_t end) = nullptr;  ///< none: go home
    void* function = nullptr;
    std::size_t blocks = 0;
  };
  /// On a cache line of its own.
  struct alignas(64) Run {
    std::atomic<bool> taken{false};
    std::exception_ptr thrown;
  };
  /// First block of a run.
  [[nodiscard]] std::size_t begin_of(std::size_t blocks, std::size_t run) const;
  void share_out(const Job& job);
  void take_runs(std::size_t thread);
  void do_run(std::size_t run);
  void rethrow_first();
  void open_gate();
  void close_gate();
  bool enter_gate(std::uint64_t& round);
  void leave_gate();
  void work(std::size_t thread);
  void go_home();

  Job job_;
  std::vector<Run> runs_;  ///< one for each thread
  std::vector<std::thread> workers_;
  /// Workers that are in the loop, in the lower half; the upper half counts how often it was opened and closed, and is
  /// odd while it is open. On a cache line of its own, since everyone watches it.
  alignas(64) std::atomic<std::uint64_t> gate_{0};
  alignas(64) std::atomic<int> asleep_{0};
  std::mutex bed_;
  std::condition_variable wake_;
};

}  // namespace udar
