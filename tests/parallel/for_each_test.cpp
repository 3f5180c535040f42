#include "udar/parallel/for_each.hpp"

#include <doctest/doctest.h>
#include <pthread.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <ctime>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "udar/base/error.hpp"

using namespace udar;

TEST_CASE("every block is visited once, by threads in contiguous runs") {
  for (const int threads : {1, 2, 3, 4, 7}) {
    Pool pool(threads);
    CHECK(pool.threads() == threads);
    for (const std::size_t blocks : {0, 1, 2, 3, 5, 8, 100}) {
      std::vector<int> visits(blocks);
      std::vector<std::thread::id> who(blocks);
      pool.for_each_block(blocks, [&](std::size_t block) {
        ++visits[block];
        who[block] = std::this_thread::get_id();
      });
      CHECK(visits == std::vector<int>(blocks, 1));
      int runs = blocks > 0 ? 1 : 0;
      for (std::size_t i = 1; i < blocks; ++i) runs += who[i] == who[i - 1] ? 0 : 1;
      CHECK(runs <= threads);
    }
  }
}

TEST_CASE("partial sums added in block order have the same bits for any number of threads") {
  const auto sum = [](int threads) {
    constexpr std::size_t blocks = 37;
    std::vector<double> partial(blocks);
    Pool(threads).for_each_block(blocks, [&](std::size_t block) {
      for (std::size_t i = 1; i <= 1000; ++i) partial[block] += 1.0 / static_cast<double>(1000 * block + i);
    });
    return std::accumulate(partial.begin(), partial.end(), 0.0);
  };
  const double expected = sum(1);
  for (const int threads : {2, 3, 4, 8}) CHECK(sum(threads) == expected);
}

TEST_CASE("what one loop writes the next one reads, many thousand times") {
  Pool pool(3);
  constexpr std::size_t blocks = 5;
  std::vector<long> a(blocks, 1);
  std::vector<long> b(blocks);
  constexpr int rounds = 20000;
  for (int round = 0; round < rounds; ++round) {
    pool.for_each_block(blocks, [&](std::size_t i) { b[i] = a[(i + 1) % blocks] + 1; });
    pool.for_each_block(blocks, [&](std::size_t i) { a[i] = b[(i + 2) % blocks]; });
  }
  CHECK(a == std::vector<long>(blocks, 1 + rounds));
}

TEST_CASE("every job is done once, however long the others take") {
  for (const int threads : {1, 2, 4}) {
    Pool pool(threads);
    for (const std::size_t jobs : {0, 1, 3, 50}) {
      std::vector<int> visits(jobs);
      pool.for_each_job(jobs, [&](std::size_t job) {
        if (job == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
        ++visits[job];
      });
      CHECK(visits == std::vector<int>(jobs, 1));
    }
    CHECK_THROWS_AS(pool.for_each_job(9, [](std::size_t job) { throw std::out_of_range(std::to_string(job)); }),
                    std::out_of_range);
  }
}

TEST_CASE("threads that fell asleep wake up") {
  Pool pool(4);
  for (int round = 0; round < 5; ++round) {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    std::vector<int> visits(16);
    pool.for_each_block(16, [&](std::size_t block) {
      if (block == 15) std::this_thread::sleep_for(std::chrono::milliseconds(20));  // the caller sleeps as well
      ++visits[block];
    });
    CHECK(visits == std::vector<int>(16, 1));
  }
}

namespace {

std::atomic<int> held = 0;
std::atomic<bool> let_go = false;

/// Holds the thread that gets the signal, as a system does that has put it aside.
void hold(int) {
  held.fetch_add(1);
  const timespec moment{0, 1000000};
  while (!let_go.load()) nanosleep(&moment, nullptr);
}

}  // namespace

TEST_CASE("nobody waits for a thread that does not come") {
  constexpr std::size_t threads = 4;
  Pool pool(threads);
  std::vector<pthread_t> who(threads);
  std::atomic<std::size_t> come = 0;
  pool.for_each_block(threads, [&](std::size_t block) {
    who[block] = pthread_self();
    come.fetch_add(1);
    while (come.load() < threads) std::this_thread::yield();
  });

  std::this_thread::sleep_for(std::chrono::milliseconds(50));  // they sleep, and none holds the lock of the pool
  std::signal(SIGUSR1, hold);
  for (const pthread_t thread : who) {
    if (pthread_equal(thread, pthread_self()) == 0) REQUIRE(pthread_kill(thread, SIGUSR1) == 0);
  }
  while (held.load() < static_cast<int>(threads) - 1) std::this_thread::yield();

  std::vector<std::thread::id> did(threads);
  pool.for_each_block(threads, [&](std::size_t block) { did[block] = std::this_thread::get_id(); });
  let_go.store(true);
  CHECK(did == std::vector<std::thread::id>(threads, std::this_thread::get_id()));
}

TEST_CASE("an exception comes out on the caller and the pool lives on") {
  for (const int threads : {1, 2, 4}) {
    Pool pool(threads);
    for (int round = 0; round < 200; ++round) {
      const auto fail_late = [](std::size_t block) {
        if (block >= 3) throw std::runtime_error("block " + std::to_string(block));
      };
      CHECK_THROWS_WITH(pool.for_each_block(12, fail_late), "block 3");
      int calls = 0;
      pool.for_each_block(1, [&](std::size_t) { ++calls; });
      CHECK(calls == 1);
    }
  }
}

TEST_CASE("pools come and go") {
  for (int i = 0; i < 200; ++i) {
    Pool pool(1 + i % 4);
    if (i % 3 == 0) pool.for_each_block(2, [](std::size_t) {});
  }
}

TEST_CASE("a callable may be const or without state") {
  Pool pool(2);
  const auto nothing = [](std::size_t) {};
  pool.for_each_block(10, nothing);
}

TEST_CASE("there is a thread to run on") { CHECK(available_threads() >= 1); }

TEST_CASE("less than one thread is refused") {
  for (const int threads : {0, -1}) {
    try {
      Pool pool(threads);
      FAIL("accepted");
    } catch (const UserError& error) {
      CHECK(error.code == ExitCode::usage);
    }
  }
}
