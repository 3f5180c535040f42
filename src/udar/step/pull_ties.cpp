#include "udar/step/stages.hpp"

namespace udar {

void pull_ties(const Model& model, BodyContact& contact) {
  contact.tie_pulls.clear();
  for (const Tie& tie : model.ties) {
    const Segment& s = model.segments[tie.segment];
    const TiePull now = pull(tie, contact.places[tie.point], contact.places[s.a], contact.places[s.b]);
    contact.forces[tie.point] += now.on_point;
    contact.forces[s.a] += now.on_a;
    contact.forces[s.b] += now.on_b;
    contact.tie_pulls.push_back(now);
  }
}

}  // namespace udar
