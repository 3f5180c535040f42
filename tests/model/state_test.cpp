#include "udar/model/state.hpp"

#include <doctest/doctest.h>

#include <set>
#include <string>

#include "udar/model/model.hpp"

using namespace udar;

TEST_CASE("for_each_field names every member of the state, each once") {
  State state;
  std::size_t bytes = 0;
  std::set<const void*> places;
  std::set<std::string> names;
  int fields = 0;
  for_each_field(state, [&](const char* name, auto& field) {
    bytes += sizeof field;
    places.insert(&field);
    names.insert(name);
    ++fields;
  });
  // All members are multiples of 8 bytes: one that is forgotten is missing here.
  CHECK(bytes == sizeof(State));
  CHECK(places.size() == static_cast<std::size_t>(fields));
  CHECK(names.size() == static_cast<std::size_t>(fields));
}

TEST_CASE("the velocity at t_n is half a step behind what carries the nodes on") {
  State state;
  state.nodes = {{.vx = 3, .vy = -4}};
  state.acceleration = {{10, 20}};
  state.clock.next_step = 0.1;
  CHECK(velocity(state, 0) == Vec2{2.5, -5});
  state.velocity = {{7, 8}};  // kept by the Adams integrators
  CHECK(velocity(state, 0) == Vec2{7, 8});
}

TEST_CASE("the ledger balances what came in with where it went") {
  Ledger l;
  l.start_energy = 100;
  l.book(ForceKind::gravity).work_now = 1;
  l.book(ForceKind::load).work_now = 2;
  l.book(ForceKind::support).work_now = 4;
  l.obstacle_work_now = 8;
  CHECK(l.external_work() == 15);
  l.kinetic_energy = 60;
  l.stress_work.add(30);
  l.plastic_work.add(20);
  l.contact_energy = 5;
  l.tangential_energy = 6;
  l.friction_work.add(7);
  l.dropped_energy.add(3);
  l.book(ForceKind::damping).work_now = -1;
  l.book(ForceKind::contact_damping).work_now = -3;
  CHECK(l.elastic_energy() == 10);
  CHECK(l.damped_energy() == 4);
  CHECK(l.energy_balance() == 0);
  l.kinetic_energy += 0.5;
  CHECK(l.energy_balance() == 0.5);
}

TEST_CASE("an error is relative to the start and to what was done from outside; without both there is none") {
  Ledger l;
  CHECK(l.energy_error() == 0);
  CHECK(l.identity_error() == 0);
  l.start_energy = 8;
  l.external_throughput.add(2);
  l.energy_gap = 1;
  l.identity_gap = 0.1;
  CHECK(l.energy_error() == doctest::Approx(0.1));
  CHECK(l.identity_error() == doctest::Approx(0.01));
}

TEST_CASE("a node and an element know their body, padding elements too") {
  Model model;
  model.bodies = {
      {.name = "one", .node_end = 4, .element_end = 5, .padded_end = 8},
      {.name = "two", .node_begin = 4, .node_end = 9, .element_begin = 8, .element_end = 9, .padded_end = 16}};
  CHECK(model.body_of_node(3).name == "one");
  CHECK(model.body_of_node(4).name == "two");
  CHECK(model.body_of_element(7).name == "one");
  CHECK(model.body_of_element(8).name == "two");
}
