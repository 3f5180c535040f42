// Two threads write the same number without an order. Built only where ThreadSanitizer must find that: a sanitizer that
// says nothing here says nothing elsewhere.

#include <atomic>
#include <cstddef>
#include <cstdio>

#include "udar/parallel/for_each.hpp"

int main() {
  udar::Pool pool(4);
  long sum = 0;
  // Nobody begins before a second one has come; in no order, so that this hides nothing.
  std::atomic<int> come{0};
  pool.for_each_block(4, [&](std::size_t block) {
    come.fetch_add(1, std::memory_order_relaxed);
    while (come.load(std::memory_order_relaxed) < 2) continue;
    for (int k = 0; k < 1000; ++k) sum += static_cast<long>(block);
  });
  std::printf("the sum is %ld\n", sum);
}
