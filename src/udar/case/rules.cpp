#include "udar/case/rules.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "udar/base/text.hpp"
#include "udar/case/ascii.hpp"
#include "udar/case/path.hpp"
#include "udar/mesh/grading.hpp"
#include "udar/units/quantity.hpp"

namespace udar {
namespace {

std::string length_text(double metres) { return si_text(metres, dimension::length); }

// --- names

template <class Item>
std::vector<std::string> names_of(const std::vector<Item>& items) {
  std::vector<std::string> names;
  for (const Item& item : items) names.push_back(item.name);
  return names;
}

/// Names of things that exist, for those who refer to them.
class Known {
 public:
  template <class Item>
  Known(std::string what, const std::vector<Item>& items)
      : what_(std::move(what)), names_(names_of(items)), set_(names_.begin(), names_.end()) {}

  void check(const std::string& name, const std::string& path, Mistakes& mistakes) const {
    if (set_.contains(name) || mistakes.full()) return;
    const std::string near = nearest_word(name, names_);
    const std::string cure = names_.empty() ? fmt::format("add a {}", what_)
                             : near.empty() ? fmt::format("there is {}", few(names_))
                                            : fmt::format("did you mean \"{}\"?", near);
    mistakes.add_unless_touched({path, fmt::format("there is no {} \"{}\"", what_, shown(name)), "", cure});
  }

 private:
  static std::string few(std::vector<std::string> names) {
    constexpr std::size_t most = 8;
    if (names.size() > most) {
      names.resize(most);
      names.emplace_back("others");
    }
    return one_of(names);
  }

  std::string what_;
  std::vector<std::string> names_;
  std::set<std::string> set_;
};

template <class Item>
void check_unique(const std::vector<Item>& items, const std::string& path, bool listed, std::set<std::string>& seen,
                  Mistakes& mistakes) {
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (seen.insert(items[i].name).second) continue;
    mistakes.add_unless_touched({listed ? join(join(path, std::to_string(i)), "name") : join(path, items[i].name),
                                 fmt::format("the name \"{}\" is taken", shown(items[i].name)),
                                 "this is the second one of that name", "choose another name"});
  }
}

// --- shapes

/// Why a polygon cannot be used; "" where it can.
std::string polygon_fault(const std::vector<Vec2>& points, bool must_be_convex) {
  const std::size_t n = points.size();
  if (n < 3) return fmt::format("it has {} corners; at least 3 are needed", n);
  double area = 0;
  double turned = 0;
  double perimeter = 0;
  bool left = false;
  bool right = false;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 before = points[(i + 1) % n] - points[i];
    const Vec2 after = points[(i + 2) % n] - points[(i + 1) % n];
    if (before == Vec2{}) return fmt::format("corner {} lies on the one before it", i + 2 > n ? 1 : i + 2);
    const double turn = std::atan2(cross(before, after), dot(before, after));
    left = left || turn > 1e-9;
    right = right || turn < -1e-9;
    turned += turn;
    perimeter += length(before);
    area += cross(points[i] - points[0], points[(i + 1) % n] - points[0]) / 2;
  }
  if (!(std::fabs(area) > 1e-12 * perimeter * perimeter)) return "its area is zero";
  if (!must_be_convex) return "";
  if (left && right) return "it is not convex";
  return std::fabs(std::fabs(turned) - 2 * std::numbers::pi) > 1e-6 ? "its outline crosses itself" : "";
}

void check_polygon(const std::vector<Vec2>& points, bool convex, const std::string& path, Mistakes& mistakes) {
  const std::string fault = polygon_fault(points, convex);
  if (fault.empty()) return;
  mistakes.add_unless_touched(
      {path, "impossible polygon", fault,
       convex ? "give the corners of a convex polygon in order, each once" : "give the corners in order, each once"});
}

/// Shapes without a rule of their own.
template <class Shape>
void check_shape(const Shape&, const std::string&, Mistakes&) {}

void check_shape(const Polygon& shape, const std::string& path, Mistakes& mistakes) {
  check_polygon(shape.points, true, join(path, "points"), mistakes);
}

void check_shape(const HalfPlane& shape, const std::string& path, Mistakes& mistakes) {
  if (length(shape.normal) > 0) return;
  mistakes.add_unless_touched(
      {join(path, "normal"), "the normal has no length", "it must point out of the obstacle", "write it like [0, 1]"});
}

constexpr double most_cells = 1e9;

/// A mesh that is not of whole cells, or of far too many.
void check_cells(double element_size, double room, const std::string& room_name, double area, const std::string& path,
                 Mistakes& mistakes) {
  const std::string key = join(path, "element_size");
  if (!(element_size > 0 && room > 0)) return;
  constexpr double rounding = 1 + 1e-9;
  if (element_size > room * rounding) {
    mistakes.add_unless_touched(
        {key, "the elements are larger than the body",
         fmt::format("{} against {} of {}", length_text(element_size), room_name, length_text(room)),
         fmt::format("write \"{}\" or less", length_text(room))});
  } else if (area / element_size / element_size > most_cells) {
    mistakes.add_unless_touched({key, "far too many elements",
                                 fmt::format("about {:.0e} of them", area / element_size / element_size),
                                 "choose larger elements, or check the units"});
  }
}

template <class Mesh>
void check_grading_keys(const Mesh& mesh, double area, const std::string& path, Mistakes& mistakes) {
  if (!(mesh.element_size > 0)) return;
  if (const auto fault = grading_fault(mesh)) {
    mistakes.add_unless_touched({join(path, fault->key), fault->message, fault->reason, fault->cure});
    return;
  }
  if (!mesh.finest_size) return;
  // Cells one behind the other until they are no longer fine, and side by side round a point or along a side.
  const double width = std::sqrt(area);
  const double deep = std::min(mesh.finest_within, width) / *mesh.finest_size + 1 / (mesh.growth - 1);
  const double broad = mesh.finest_at ? deep : width / *mesh.finest_size;
  if (deep * broad <= most_cells) return;
  mistakes.add_unless_touched({join(path, "finest_size"), "far too many elements",
                               fmt::format("about {:.0e} of them", deep * broad),
                               "choose larger elements, a smaller finest_within, or check the units"});
}

void check_shape(const RectangleMesh& mesh, const std::string& path, Mistakes& mistakes) {
  const double smaller = std::min(mesh.size.x, mesh.size.y);
  check_cells(mesh.element_size, smaller, "the smaller side", mesh.size.x * mesh.size.y, path, mistakes);
  check_grading_keys(mesh, mesh.size.x * mesh.size.y, path, mistakes);
}

void check_shape(const DiscMesh& mesh, const std::string& path, Mistakes& mistakes) {
  check_cells(mesh.element_size, mesh.radius, "the radius", 3 * mesh.radius * mesh.radius, path, mistakes);
  check_grading_keys(mesh, 3 * mesh.radius * mesh.radius, path, mistakes);
}

void check_shape(const RingMesh& mesh, const std::string& path, Mistakes& mistakes) {
  const double wall = mesh.outer_radius - mesh.inner_radius;
  if (wall <= 0) {
    mistakes.add_unless_touched({join(path, "inner_radius"), "the ring has no wall",
                                 fmt::format("the outer radius is {}", length_text(mesh.outer_radius)),
                                 "make the inner radius smaller than the outer one"});
  }
  check_cells(mesh.element_size, wall, "the wall", 3 * wall * (mesh.outer_radius + mesh.inner_radius), path, mistakes);
  check_grading_keys(mesh, 3 * wall * (mesh.outer_radius + mesh.inner_radius), path, mistakes);
}

template <class Variant>
void check_variant(const Variant& shape, const std::string& path, Mistakes& mistakes) {
  std::visit([&](const auto& s) { check_shape(s, path, mistakes); }, shape);
}

// --- sections

void check_run(const RunSettings& run, Mistakes& mistakes) {
  if (run.integrator != Integrator::adams2) return;
  if (!run.time_step) {
    mistakes.add_unless_touched({"run.time_step", "adams2 needs a fixed time_step",
                                 "it is never stable, so no step can be chosen for it",
                                 "add time_step = \"6.4e-8 s\""});
  }
  if (run.when_unstable != WhenUnstable::carry_on) {
    mistakes.add_unless_touched({"run.when_unstable", "adams2 needs when_unstable = \"continue\"",
                                 "it is never stable: every step is beyond its limit",
                                 "add when_unstable = \"continue\""});
  }
}

void check_selection(const Selection& s, const std::string& path, bool edges, Mistakes& mistakes) {
  const int ways = int(!s.side.empty()) + int(!s.box.empty()) + int(!s.line.empty()) + int(s.point.has_value());
  if (ways != 1) {
    mistakes.add_unless_touched({path, ways == 0 ? "nothing is selected" : "selected in more than one way",
                                 "one of side, box, line or point is needed", "write it like { side = \"left\" }"});
    return;
  }
  if (edges && s.point) {
    mistakes.add_unless_touched({join(path, "point"), "a point selects no edges",
                                 "a traction or pressure acts on edges", "use side, box or line, or a force on nodes"});
  }
  if (s.line.size() == 2 && s.line[0] == s.line[1]) {
    mistakes.add_unless_touched(
        {join(path, "line"), "the line has no length", "", "give two different ends, or a point"});
  }
}

/// Looked up once: a case may have ten thousand bodies and as many supports.
std::set<std::string> rigid_bodies(const Case& c) {
  std::set<std::string> names;
  for (const BodyCase& body : c.bodies) {
    if (body.rigid) names.insert(body.name);
  }
  return names;
}

void check_supports(const Case& c, const Known& bodies, Mistakes& mistakes) {
  const std::set<std::string> rigid = rigid_bodies(c);
  for (const SupportCase& s : c.supports) {
    const std::string path = join("supports", s.name);
    bodies.check(s.nodes.body, join(path, "body"), mistakes);
    check_selection(s.nodes, join(path, "nodes"), false, mistakes);
    if (rigid.contains(s.nodes.body)) {
      mistakes.add_unless_touched({join(path, "body"), fmt::format("the body \"{}\" is rigid", shown(s.nodes.body)),
                                   "it moves by its mass and what pushes it; supports hold nodes of others",
                                   "what moves as given is an obstacle: make it one, with a velocity"});
    }
    if (s.turn && (s.move_x || s.move_y)) {
      mistakes.add_unless_touched({join(path, "turn"), "a support either turns or moves",
                                   "it has move_x or move_y as well", "leave one of them out"});
    }
    if (!s.turn && !s.move_x && !s.move_y) {
      mistakes.add_unless_touched({path, fmt::format("the support \"{}\" holds nothing", s.name),
                                   "one of move_x, move_y or turn is needed", "add move_y = \"0 m\""});
    }
  }
}

std::string selection_key(const LoadCase& load) { return load.kind == LoadCase::Kind::force ? "nodes" : "edges"; }

void check_contact_pairs(const Case& c, const Known& bodies, Mistakes& mistakes) {
  std::set<std::pair<std::string, std::string>> seen;
  for (std::size_t i = 0; i < c.contact_pairs.size(); ++i) {
    const ContactPairCase& pair = c.contact_pairs[i];
    const std::string path = join("contact.pairs", std::to_string(i));
    bodies.check(pair.body, join(path, "body"), mistakes);
    bodies.check(pair.other, join(path, "other"), mistakes);
    if (pair.touch == ContactPairCase::Touch::tied && pair.body == pair.other) {
      mistakes.add_unless_touched({join(path, "touch"), "a body cannot be tied to itself",
                                   "its mesh holds it together already", "name two bodies, or leave the pair out"});
    }
    if (seen.insert(std::minmax(pair.body, pair.other)).second) continue;
    mistakes.add_unless_touched({join(path, "other"),
                                 fmt::format("the pair {}, {} stands here twice", pair.body, pair.other),
                                 "what holds for it must be said once", "put the keys of both into one"});
  }
}

void check_loads(const Case& c, const Known& bodies, Mistakes& mistakes) {
  for (const LoadCase& load : c.loads) {
    const std::string path = join("loads", load.name);
    bodies.check(load.where.body, join(path, "body"), mistakes);
    check_selection(load.where, join(path, selection_key(load)), load.kind != LoadCase::Kind::force, mistakes);
  }
}

template <class Observer>
void check_observers(const std::vector<Observer>& observers, const std::string& path, const Known& bodies,
                     std::set<std::string>& names, Mistakes& mistakes) {
  for (std::size_t i = 0; i < observers.size(); ++i) {
    const std::string item = join(path, std::to_string(i));
    bodies.check(observers[i].body, join(item, "body"), mistakes);
    if constexpr (requires { observers[i].polygon; }) {
      check_polygon(observers[i].polygon, false, join(item, "polygon"), mistakes);
    }
  }
  check_unique(observers, path, true, names, mistakes);
}

template <class Item>
void check_names(const std::vector<Item>& items, const std::string& path, Mistakes& mistakes) {
  std::set<std::string> names;
  check_unique(items, path, false, names, mistakes);
}

}  // namespace

void check_rules(const Case& c, Mistakes& mistakes) {
  check_run(c.run, mistakes);
  check_names(c.materials, "materials", mistakes);
  check_names(c.bodies, "bodies", mistakes);
  check_names(c.obstacles, "obstacles", mistakes);
  check_names(c.supports, "supports", mistakes);
  check_names(c.loads, "loads", mistakes);

  const Known materials("material", c.materials);
  const Known bodies("body", c.bodies);
  if (c.bodies.empty()) {
    mistakes.add_unless_touched(
        {"bodies", "there is no body", "a case needs at least one", "add a table [bodies.NAME]"});
  }
  for (const BodyCase& body : c.bodies) {
    const std::string path = join("bodies", body.name);
    materials.check(body.material, join(path, "material"), mistakes);
    if (body.rigid && body.cosine_mode) {
      mistakes.add_unless_touched({join(path, "cosine_mode"), "a rigid body has one velocity and one spin",
                                   "a cosine mode would deform it", "leave it out, or rigid = true"});
    }
    check_variant(body.mesh, join(path, "mesh"), mistakes);
  }
  for (const ObstacleCase& obstacle : c.obstacles) {
    check_variant(obstacle.shape, join("obstacles", obstacle.name), mistakes);
  }
  check_contact_pairs(c, bodies, mistakes);
  check_supports(c, bodies, mistakes);
  check_loads(c, bodies, mistakes);

  std::set<std::string> observers;
  check_observers(c.observed_nodes, "observe.nodes", bodies, observers, mistakes);
  check_observers(c.observed_elements, "observe.elements", bodies, observers, mistakes);
  const std::set<std::string> rigid = rigid_bodies(c);
  for (std::size_t i = 0; i < c.observed_elements.size(); ++i) {
    if (!rigid.contains(c.observed_elements[i].body)) continue;
    mistakes.add_unless_touched({join(join("observe.elements", std::to_string(i)), "body"),
                                 fmt::format("the body \"{}\" is rigid", shown(c.observed_elements[i].body)),
                                 "its elements have no stress", "observe one of its nodes instead"});
  }
  check_observers(c.observed_regions, "observe.regions", bodies, observers, mistakes);
}

void find_doubts(const Case& c, const Mistakes& mistakes, Mistakes& doubts) {
  const auto doubt = [&](Mistake m) {
    if (!mistakes.touched(m.path)) doubts.add_unless_touched(std::move(m));
  };
  for (const MaterialCase& material : c.materials) {
    const std::string path = join("materials", material.name);
    const double modulus = std::visit([](const auto& law) { return law.elasticity().wave_modulus(); }, material.law);
    const double speed = std::sqrt(modulus / material.density);
    if (speed >= 50 && speed <= 20e3) continue;
    doubt({path, fmt::format("the wave speed of \"{}\" is {:.3g} m/s", material.name, speed),
           fmt::format("solids have 50 m/s to 20 km/s"),
           speed < 50 ? "did you mean GPa? check the units of the moduli and the density"
                      : "did you mean MPa? check the units of the moduli and the density"});
  }
  std::set<std::string> used;
  for (const BodyCase& body : c.bodies) used.insert(body.material);
  for (const MaterialCase& material : c.materials) {
    if (used.contains(material.name)) continue;
    doubt({join("materials", material.name), fmt::format("no body is made of \"{}\"", material.name), "",
           "leave it out or use it"});
  }
  for (std::size_t i = 0; i < c.output.fields_at.size(); ++i) {
    if (c.output.fields_at[i] <= c.run.end_time) continue;
    doubt({join("output.fields_at", std::to_string(i)), "fields are asked for after the end",
           fmt::format("the run ends at {}", si_text(c.run.end_time, dimension::time)),
           "lengthen the run or leave it out"});
  }
  constexpr double many_frames = 1e5;
  if (c.output.fields_every && c.run.end_time / *c.output.fields_every > many_frames) {
    doubt({"output.fields_every", "very many pictures of the fields",
           fmt::format("{:.0f} of them", c.run.end_time / *c.output.fields_every), "write them less often"});
  }
}

}  // namespace udar
