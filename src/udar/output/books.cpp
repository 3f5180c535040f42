#include <algorithm>
#include <limits>

#include "udar/output/observer.hpp"

namespace udar {

double stored_elastic_energy(const Model& model, const State& state) {
  double sum = 0;
  for (const Body& body : model.bodies) {
    const Elasticity c = std::visit([](const auto& law) { return law.elasticity(); }, body.law);
    const double shear = c.shear_modulus;
    const double trace_part = c.lambda / (2 * shear * (3 * c.lambda + 2 * shear));
    for (Index e = body.element_begin; e < body.element_end; ++e) {
      const double xx = state.stress_xx[e];
      const double yy = state.stress_yy[e];
      const double xy = state.stress_xy[e];
      const double zz = state.stress_zz[e];
      const double trace = xx + yy + zz;
      const double squares = xx * xx + yy * yy + zz * zz + 2 * xy * xy;
      const auto place = [&](int i) {
        const NodeRecord& r = state.nodes[model.corners[e][static_cast<std::size_t>(i)]];
        return Vec2{r.x, r.y};
      };
      const double volume = 0.5 * body.thickness * twice_area(place(0), place(1), place(2));
      sum += 0.5 * volume * (squares / (2 * shear) - trace_part * trace * trace);
    }
  }
  return sum;
}

Observer observe_energy(const Model&) {
  return {"energy",
          {{"kinetic", "J"},
           {"elastic", "J"},
           {"plastic", "J"},
           {"contact", "J"},
           {"ties", "J"},
           {"friction", "J"},
           {"dropped", "J"},
           {"damping", "J"},
           {"gravity", "J"},
           {"loads", "J"},
           {"supports", "J"},
           {"obstacles", "J"},
           {"total", "J"},
           {"error", "J"}},
          {0, std::numeric_limits<double>::infinity()},
          [](const State& state, std::span<double> out) {
            const Ledger& l = state.ledger;
            const double contact = l.contact_energy + l.tangential_energy;
            const std::array values{l.kinetic_energy,
                                    l.elastic_energy(),
                                    l.plastic_work.value(),
                                    contact,
                                    l.tie_energy,
                                    l.friction_work.value(),
                                    l.dropped_energy.value(),
                                    l.damped_energy(),
                                    l.book(ForceKind::gravity).work_now,
                                    l.book(ForceKind::load).work_now,
                                    l.book(ForceKind::support).work_now,
                                    l.obstacle_work_now,
                                    l.total_energy(),
                                    l.energy_balance()};
            std::copy(values.begin(), values.end(), out.begin());
          }};
}

Observer observe_momentum(const Model&) {
  return {"momentum",
          {{"momentum_x", "kg m/s"},
           {"momentum_y", "kg m/s"},
           {"spin", "kg m^2/s"},
           {"obstacles_x", "N s"},
           {"obstacles_y", "N s"},
           {"gravity_x", "N s"},
           {"gravity_y", "N s"},
           {"loads_x", "N s"},
           {"loads_y", "N s"},
           {"supports_x", "N s"},
           {"supports_y", "N s"},
           {"damping_x", "N s"},
           {"damping_y", "N s"},
           {"error_x", "N s"},
           {"error_y", "N s"}},
          {0, std::numeric_limits<double>::infinity()},
          [](const State& state, std::span<double> out) {
            const Ledger& l = state.ledger;
            Vec2 contact;
            for (const ContactBook& obstacle : state.obstacles) contact += obstacle.total.impulse();
            const Vec2 gravity = l.book(ForceKind::gravity).impulse();
            const Vec2 loads = l.book(ForceKind::load).impulse();
            const Vec2 supports = l.book(ForceKind::support).impulse();
            const Vec2 damping = l.book(ForceKind::damping).impulse();
            const Vec2 error = l.momentum - l.start_momentum - contact - gravity - loads - supports - damping;
            const std::array values{l.momentum.x, l.momentum.y, l.spin,    contact.x, contact.y,
                                    gravity.x,    gravity.y,    loads.x,   loads.y,   supports.x,
                                    supports.y,   damping.x,    damping.y, error.x,   error.y};
            std::copy(values.begin(), values.end(), out.begin());
          }};
}

}  // namespace udar
