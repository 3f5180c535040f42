#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace udar {

/// A thread that does jobs one after another, in the order in which they come, beside the thread that hands them over.
/// It begins with the first job; where the system gives no thread, a job is done before `add` returns.
///
/// What a job throws is thrown by the next call of `add`, `rethrow` or `finish`; the jobs that waited behind it are
/// left out. All calls but those of the jobs are made by one thread.
class Background {
 public:
  using Job = std::function<void()>;

  Background() = default;
  /// After some jobs `when_idle` is done as well: when no other one has come for `patience`, and by `finish`.
  Background(Job when_idle, std::chrono::milliseconds patience)
      : when_idle_(std::move(when_idle)), patience_(patience) {}
  /// Does what waits and forgets what is thrown: call `finish` where it matters.
  ~Background();
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  void add(Job job);
  /// Waits until no more than `most` jobs are left, the one that is being done among them.
  void wait(std::size_t most);
  /// Waits until all is done.
  void finish();
  /// Costs nearly nothing where nothing was thrown.
  void rethrow() {
    if (failed_.load(std::memory_order_relaxed)) throw_it();
  }

 private:
  void begin();
  void work();
  void attempt(std::unique_lock<std::mutex>& door, const Job& job);
  void throw_it();

  Job when_idle_ = [] {};
  std::chrono::milliseconds patience_{0};
  std::mutex door_;               ///< to all below but the thread
  std::condition_variable came_;  ///< a job, someone who waits for all, or the end
  std::condition_variable done_;
  std::deque<Job> jobs_;  ///< the first one is being done
  bool all_done_ = true;  ///< `when_idle` too
  bool no_patience_ = false;
  bool end_ = false;
  std::exception_ptr thrown_;
  std::atomic<bool> failed_{false};  ///< whether there is something thrown, for a look without the lock
  std::thread thread_;
};

}  // namespace udar
