#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <thread>
#include <type_traits>
#include <vector>

namespace udar {

/// Threads that the machine runs at once; at least 1.
int available_threads();

/// Threads that share out the blocks of a loop. Between two loops they spin for a moment, then yield, then sleep: a
/// pure spin barrier collapses when another job shares the cores, and sleeping at once costs more than a small loop.
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

  /// Calls f(block) for every block in 0 .. blocks - 1; each thread takes the run of neighbours that `thread_of` says.
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

  /// Which thread takes a block of so many.
  [[nodiscard]] std::size_t thread_of(std::size_t blocks, std::size_t block) const;

 private:
  struct Job {
    void (*run)(void* function, std::size_t begin, std::size_t end) = nullptr;  ///< none: go home
    void* function = nullptr;
    std::size_t blocks = 0;
  };
  /// First block of a thread's run.
  [[nodiscard]] std::size_t begin_of(std::size_t blocks, std::size_t thread) const;
  void share_out(const Job& job);
  void run_share(std::size_t thread);
  void work(std::size_t thread);
  void go_home();

  Job job_;
  std::vector<std::exception_ptr> thrown_;  ///< one for each thread
  std::vector<std::thread> workers_;
  // On cache lines of their own: everyone watches the first, everyone writes the second.
  alignas(64) std::atomic<std::uint32_t> round_{0};
  alignas(64) std::atomic<std::uint32_t> still_working_{0};
};

}  // namespace udar
