// The hot loops, compiled for the processor that builds them.

#include "run.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <iterator>
#include <thread>

#include "deform.hpp"

namespace roof {
namespace {

using namespace UDAR_ISA;

/// Spins, then yields: a core may be shared with another job.
class Barrier {
 public:
  explicit Barrier(int threads) : threads_(threads) {}

  void wait() {
    if (threads_ == 1) return;
    constexpr int spins = 2000;
    const int round = round_.load(std::memory_order_relaxed);
    if (arrived_.fetch_add(1, std::memory_order_acq_rel) == threads_ - 1) {
      arrived_.store(0, std::memory_order_relaxed);
      round_.store(round + 1, std::memory_order_release);
      return;
    }
    for (int k = 0; round_.load(std::memory_order_acquire) == round; ++k) {
      if (k > spins) std::this_thread::yield();
#if defined(__x86_64__)
      __builtin_ia32_pause();
#endif
    }
  }

 private:
  const int threads_;
  alignas(64) std::atomic<int> arrived_{0};
  alignas(64) std::atomic<int> round_{0};
};

using Pair = double __attribute__((vector_size(16)));

[[gnu::always_inline]] inline Pair load_pair(const void* from) {
  Pair pair;
  __builtin_memcpy(&pair, from, sizeof pair);
  return pair;
}

/// New velocities and places of a run; `sum` adds up the forces at slots.
template <class Sum>
[[gnu::always_inline]] inline void move_run(Problem& p, const Run& run, Sum&& sum) {
  const double h = p.step;
  const Pair fall{0, -h * p.beam.gravity};
  const char* forces = reinterpret_cast<const char*>(p.forces.data());
  const Index* slots = p.slots.data() + run.slot;
  const double* kick = p.kick.data();
  Node* nodes = p.nodes.data();
  for (Index i = run.begin; i < run.end; ++i, slots += run.forces) {
    const Pair v = load_pair(&nodes[i].vx) + (kick[i] * sum(forces, slots) + fall);
    const Pair x = load_pair(&nodes[i].x) + h * v;
    __builtin_memcpy(&nodes[i].x, &x, sizeof x);
    __builtin_memcpy(&nodes[i].vx, &v, sizeof v);
  }
}

void move(Problem& p, const Stretch& stretch) {
  for (Index r = stretch.run_begin; r < stretch.run_end; ++r) {
    const Run& run = p.runs[r];
    if (run.forces == 4) {
      move_run(p, run, [](const char* forces, const Index* slots) {
        return (load_pair(forces + slots[0]) + load_pair(forces + slots[1])) +
               (load_pair(forces + slots[2]) + load_pair(forces + slots[3]));
      });
    } else {
      move_run(p, run, [count = run.forces](const char* forces, const Index* slots) {
        Pair total = load_pair(forces + slots[0]);
        for (Index k = 1; k < count; ++k) total += load_pair(forces + slots[k]);
        return total;
      });
    }
  }
}

/// Face of the stop that a point below it is nearest to: its top, or a side falling at 45 degrees.
struct Face {
  double distance = 0;  ///< m, negative inside
  double nx = 0, ny = 0;
  Index number = 0;
};

Face nearest_face(const Beam& beam, const Node& node) {
  const double to_side = std::sqrt(0.5) * (std::fabs(node.x) - beam.stop_half_width + node.y);
  if (node.y > to_side) return {node.y, 0, 1, 1};
  return {to_side, std::copysign(std::sqrt(0.5), node.x), std::sqrt(0.5), node.x > 0 ? Index{2} : Index{3}};
}

/// Penalty springs and Coulomb friction, as udar/contact/penalty.hpp has them.
void press(Problem& p, Index begin, Index end) {
  const double stiffness = p.beam.spring * 2 / p.beam.thickness;
  for (Index k = begin; k < end; ++k) {
    WallNode& w = p.wall[k];
    const Node& node = p.nodes[w.node];
    const Face face = node.y < 0 ? nearest_face(p.beam, node) : Face{};
    const Index before = w.face;
    w.face = face.distance < 0 ? face.number : 0;
    p.forces[w.slot] = {};
    if (w.face == 0) continue;
    const double slid = p.step * (node.vy * face.nx - node.vx * face.ny);
    const double most = -p.beam.friction * face.distance;
    w.slip = w.face == before ? std::clamp(w.slip + slid, -most, most) : 0;
    p.forces[w.slot] = {stiffness * (w.slip * face.ny - face.distance * face.nx),
                        -stiffness * (w.slip * face.nx + face.distance * face.ny)};
  }
}

template <bool books>
void steps_of(Problem& p, std::size_t thread, std::uint64_t steps, Barrier& barrier, Books& sums) {
  const Share& share = p.shares[thread];
  const Constants constants(p.beam.law, p.step);
  for (std::uint64_t n = 0; n < steps; ++n) {
    press(p, share.wall_begin, share.wall_end);
    for (const Stretch& stretch : share.stretches) {
      deform<books>(p, stretch, constants, sums);
      move(p, stretch);
    }
    barrier.wait();
    move(p, share.late);
    barrier.wait();
  }
}

template <bool books>
double run_all(Problem& p, std::uint64_t steps, Books& total) {
  const auto threads = static_cast<std::size_t>(p.settings.threads);
  Barrier barrier(p.settings.threads);
  std::vector<Books> sums(threads);
  std::vector<std::thread> others;
  for (std::size_t t = 1; t < threads; ++t) {
    others.emplace_back([&, t] {
      barrier.wait();
      steps_of<books>(p, t, steps, barrier, sums[t]);
    });
  }
  barrier.wait();
  const auto begin = std::chrono::steady_clock::now();
  steps_of<books>(p, 0, steps, barrier, sums[0]);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (std::thread& other : others) other.join();
  for (const Books& s : sums) {
    total.plastic_work += 0.5 * p.beam.thickness * s.plastic_work;
    total.flowing += s.flowing;
  }
  return seconds;
}

}  // namespace

std::vector<Index> slots_of_lanes() { return {std::begin(slot_of_lane), std::end(slot_of_lane)}; }

double run(Problem& problem, std::uint64_t steps, Books* books) {
  Books none;
  return books != nullptr ? run_all<true>(problem, steps, *books) : run_all<false>(problem, steps, none);
}

}  // namespace roof
