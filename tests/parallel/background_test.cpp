#include "udar/parallel/background.hpp"

#include <doctest/doctest.h>

#include <future>
#include <numeric>
#include <stdexcept>
#include <vector>

using namespace udar;
using std::chrono::milliseconds;

namespace {

std::vector<int> up_to(int count) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

}  // namespace

TEST_CASE("jobs are done in order, by one other thread") {
  std::vector<int> done;
  std::vector<std::thread::id> who;
  Background background;
  for (int k = 0; k < 1000; ++k) {
    background.add([&, k] {
      done.push_back(k);
      who.push_back(std::this_thread::get_id());
    });
    if (k % 100 == 0) background.finish();
  }
  background.finish();
  CHECK(done == up_to(1000));
  CHECK(who == std::vector<std::thread::id>(1000, who.front()));
  CHECK(who.front() != std::this_thread::get_id());
}

TEST_CASE("what waits is done when it goes out of scope") {
  std::vector<int> done;
  {
    Background background;
    for (int k = 0; k < 20; ++k) {
      background.add([&, k] {
        std::this_thread::sleep_for(milliseconds(1));
        done.push_back(k);
      });
    }
  }
  CHECK(done == up_to(20));
}

TEST_CASE("the caller can wait until few are left") {
  std::atomic<int> done{0};
  Background background;
  for (int k = 0; k < 10; ++k) {
    background.add([&] {
      std::this_thread::sleep_for(milliseconds(2));
      ++done;
    });
    background.wait(2);
    CHECK(done >= k - 1);
  }
  background.wait(0);
  CHECK(done == 10);
}

TEST_CASE("what a job throws comes out once, and those behind it are left out") {
  Background background;
  std::promise<void> go;
  std::vector<int> done;
  background.add([&] { go.get_future().wait(); });
  background.add([] { throw std::runtime_error("full"); });
  background.add([&] { done.push_back(1); });
  CHECK_NOTHROW(background.rethrow());
  go.set_value();
  background.wait(0);
  CHECK_THROWS_WITH(background.rethrow(), "full");
  CHECK_NOTHROW(background.rethrow());
  background.add([&] { done.push_back(2); });
  CHECK_NOTHROW(background.finish());
  CHECK(done == std::vector{2});
  background.add([] { throw std::runtime_error("again"); });
  CHECK_THROWS_WITH(background.finish(), "again");
  background.add([] { throw std::runtime_error("and again"); });
  background.wait(0);
  CHECK_THROWS_WITH(background.add([&] { done.push_back(3); }), "and again");
  CHECK_NOTHROW(background.finish());
  CHECK(done == std::vector{2});
}

TEST_CASE("when idle: after the last of several jobs, and always before finish returns") {
  std::vector<int> done;
  Background background([&] { done.push_back(-1); }, std::chrono::hours(1));
  background.finish();
  CHECK(done.empty());  // nothing was done, nothing is due
  for (int k = 0; k < 3; ++k) background.add([&, k] { done.push_back(k); });
  background.finish();
  background.finish();
  CHECK(done == std::vector{0, 1, 2, -1});
}

TEST_CASE("when idle: nobody has to call for it") {
  std::promise<void> came;
  Background background([&] { came.set_value(); }, milliseconds(1));
  background.add([] {});
  CHECK(came.get_future().wait_for(std::chrono::seconds(60)) == std::future_status::ready);
}

TEST_CASE("when idle: it is done after a job that threw, and may throw itself") {
  int idle = 0;
  Background background(
      [&] {
        ++idle;
        throw std::runtime_error("idle");
      },
      milliseconds(0));
  background.add([] { throw std::runtime_error("job"); });
  CHECK_THROWS_WITH(background.finish(), "job");
  CHECK(idle == 1);
  background.add([] {});
  CHECK_THROWS_WITH(background.finish(), "idle");
  CHECK(idle == 2);
}
