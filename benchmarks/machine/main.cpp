// What the machine can do: bandwidth of each level of memory, and arithmetic. One thread, and all at once.

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "../roof/array.hpp"
#include "loops.hpp"

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

/// Units of `work` per second of all threads together: each repeats its own work for a fifth of a second. The best of
/// several rounds, since anything that disturbs makes it less.
double rate(int threads, const std::function<double(int thread)>& work) {
  constexpr double duration = 0.2;
  constexpr int rounds = 3;
  double best = 0;
  for (int round = 0; round < rounds; ++round) {
    std::atomic<int> ready{0};
    std::vector<double> rates(static_cast<std::size_t>(threads));
    std::vector<std::thread> team;
    for (int t = 0; t < threads; ++t) {
      team.emplace_back([&, t] {
        work(t);  // caches, clock frequency
        ++ready;
        while (ready < threads) std::this_thread::yield();
        const auto begin = Clock::now();
        double done = 0;
        double seconds = 0;
        for (; seconds < duration; seconds = seconds_since(begin)) done += work(t);
        rates[static_cast<std::size_t>(t)] = done / seconds;
      });
    }
    for (std::thread& member : team) member.join();
    double sum = 0;
    for (const double r : rates) sum += r;
    best = std::max(best, sum);
  }
  return best;
}

/// Bytes per second where every thread runs over arrays of so many bytes, both together.
double bandwidth(int threads, std::size_t bytes) {
  const std::size_t count = bytes / 16 / 64 * 64;
  std::vector<roof::Array<double>> arrays;
  for (int t = 0; t < threads; ++t) arrays.emplace_back(2 * count, 1.0);
  const auto repeats = std::max<std::size_t>(1, (std::size_t{1} << 20) / bytes);
  return rate(threads, [&](int t) {
    double* a = arrays[static_cast<std::size_t>(t)].data();
    for (std::size_t k = 0; k < repeats; ++k) machine::triad(a, a + count, count, 1e-9);
    return machine::triad_bytes * static_cast<double>(count * repeats);
  });
}

struct Level {
  std::string name;
  std::size_t bytes;  ///< of one thread
};

std::size_t cache(int name, std::size_t if_unknown) {
  const long size = sysconf(name);
  return size > 0 ? static_cast<std::size_t>(size) : if_unknown;
}

/// Arrays that fill half of a cache; of a shared one no more than what a machine shared with others still has.
std::vector<Level> levels(int threads) {
  constexpr std::size_t mega = std::size_t{1} << 20;
  const auto team = static_cast<std::size_t>(threads);
  const std::size_t last = cache(_SC_LEVEL3_CACHE_SIZE, 32 * mega);
  return {{"L1", cache(_SC_LEVEL1_DCACHE_SIZE, mega / 32) / 2},
          {"L2", cache(_SC_LEVEL2_CACHE_SIZE, mega) / 2},
          {"L3", std::min(last / 2, 16 * mega) / team},
          {"memory", std::clamp(4 * last, 512 * mega, 2048 * mega) / team}};
}

struct Row {
  std::string what;
  int threads;
  std::size_t bytes;  ///< that each thread runs over
  double value;
  const char* unit;
};

std::vector<Row> measure_all() {
  const int all = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  std::vector<int> teams{1};
  if (all > 1) teams.push_back(all);
  constexpr std::uint64_t rounds = 100000;
  std::vector<Row> rows;
  for (const int team : teams) {
    for (const Level& level : levels(team)) {
      rows.push_back({level.name, team, level.bytes, 1e-9 * bandwidth(team, level.bytes), "GB/s"});
    }
    const auto apart = [](int) { return machine::multiply_and_add(rounds); };
    const auto fused = [](int) { return machine::fused(rounds); };
    rows.push_back({"multiply and add", team, 0, 1e-9 * rate(team, apart), "Gflop/s"});
    rows.push_back({"fused", team, 0, 1e-9 * rate(team, fused), "Gflop/s"});
  }
  return rows;
}

}  // namespace

int main(int argc, char** argv) {
  const bool json = argc == 2 && std::strcmp(argv[1], "--json") == 0;
  if (argc > 1 && !json) {
    fmt::print(stderr, "usage: machine [--json]\n");
    return 2;
  }
  for (const Row& r : measure_all()) {
    if (json) {
      fmt::print("{{\"what\": \"{}\", \"threads\": {}, \"bytes\": {}, \"value\": {:.2f}, \"unit\": \"{}\"}}\n", r.what,
                 r.threads, r.bytes, r.value, r.unit);
    } else {
      fmt::print("{:<18}{:>3} threads {:>10.1f} {}\n", r.what, r.threads, r.value, r.unit);
    }
  }
  return 0;
}
