#include "udar/parallel/background.hpp"

#include <system_error>
#include <utility>

namespace udar {

Background::~Background() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard door(door_);
    end_ = true;
  }
  came_.notify_one();
  thread_.join();
}

void Background::add(Job job) {
  rethrow();
  begin();
  std::unique_lock door(door_);
  jobs_.push_back(std::move(job));
  all_done_ = false;
  if (thread_.joinable()) return came_.notify_one();
  attempt(door, jobs_.front());
  jobs_.clear();
  door.unlock();
  rethrow();
}

void Background::wait(std::size_t most) {
  std::unique_lock door(door_);
  done_.wait(door, [&] { return jobs_.size() <= most; });
}

void Background::finish() {
  std::unique_lock door(door_);
  if (thread_.joinable()) {
    no_patience_ = true;
    came_.notify_one();
    done_.wait(door, [&] { return all_done_; });
    no_patience_ = false;
  } else if (!std::exchange(all_done_, true)) {
    attempt(door, when_idle_);
  }
  door.unlock();
  rethrow();
}

void Background::begin() {
  if (thread_.joinable()) return;
  try {
    thread_ = std::thread([this] { work(); });
  } catch (const std::system_error&) {
    // It goes without, only slower.
  }
}

void Background::work() {
  std::unique_lock door(door_);
  while (true) {
    const auto wanted = [&] { return !jobs_.empty() || end_ || (no_patience_ && !all_done_); };
    if (all_done_) {
      came_.wait(door, wanted);
    } else {
      came_.wait_for(door, patience_, wanted);
    }
    if (!jobs_.empty()) {
      attempt(door, jobs_.front());
      if (!jobs_.empty()) jobs_.pop_front();
    } else if (!all_done_) {
      attempt(door, when_idle_);
      all_done_ = jobs_.empty();
    } else if (end_) {
      return;
    }
    done_.notify_one();
  }
}

/// Does a job with the door open; where it throws, all that wait are dropped.
void Background::attempt(std::unique_lock<std::mutex>& door, const Job& job) {
  door.unlock();
  std::exception_ptr thrown;
  try {
    job();
  } catch (...) {
    thrown = std::current_exception();
  }
  door.lock();
  if (!thrown) return;
  jobs_.clear();
  if (!thrown_) thrown_ = thrown;
  failed_ = true;
}

void Background::throw_it() {
  std::unique_lock door(door_);
  const std::exception_ptr thrown = std::exchange(thrown_, nullptr);
  failed_ = false;
  door.unlock();
  std::rethrow_exception(thrown);
}

}  // namespace udar
