#include "udar/case/keys.hpp"

#include <functional>

#include "udar/case/tables.hpp"

namespace udar {
namespace {

constexpr QuantityKind any_length{dimension::length};
const VectorKind place{any_length};
const VectorKind velocity{{dimension::velocity}};
const NameKind body_name{"name of a body", "beam"};
const NameKind own_name{"name", "corner"};
constexpr QuantityKind positive_time{dimension::time, limits::positive};

const Schema<MassDamping>& damping_schema() {
  using D = MassDamping;
  static const Schema<D> schema{
      .doc =
          "Damping proportional to mass: force = -rate m (v - v0). For heaps to come to rest and quasi-static "
          "problems.",
      .keys = {
          key("rate", &D::rate, QuantityKind{dimension::rate, limits::not_negative}, "0: no damping", required),
          key("against", &D::against, WordKind{{"rest", "mean_motion"}}, "v0: rest or the mean velocity of the body"),
          key("factor", &D::factor, TimeTableKind{{dimension::number, limits::not_negative}}, "multiplies the rate"),
      }};
  return schema;
}

const Schema<RunSettings>& run_schema() {
  using R = RunSettings;
  static const Schema<R> schema{
      .doc = "What is computed, and how.",
      .keys = {
          key("end_time", &R::end_time, positive_time, "how long is computed", required),
          key("integrator", &R::integrator, WordKind{{integrator_words.begin(), integrator_words.end()}},
              "how velocities and positions are carried over a step"),
          key("time_step", &R::time_step, QuantityOrWordKind{positive_time, "auto"},
              "a fixed step, or step_safety of the stable limit", Need::optional, "\"6.4e-8 s\""),
          key("step_safety", &R::step_safety,
              QuantityKind{dimension::number, {.low = 0, .high = 1, .low_included = false}},
              "automatic step over stable limit", Need::optional, "0.9"),
          key("when_unstable", &R::when_unstable, WordKind{{"shorten", "stop", "continue"}},
              "what to do when the stable limit falls below a fixed step"),
          key("stop_at_energy_error", &R::stop_at_energy_error, QuantityKind{dimension::number, limits::positive},
              "the run stops when the energy balance is off by more than this part", Need::optional, "0.05"),
          key("gravity", &R::gravity, VectorKind{{dimension::acceleration}}, "acts on every body", Need::optional,
              "[\"0 m/s^2\", \"-9.81 m/s^2\"]"),
          key("damping", &R::damping, InlineTableKind<MassDamping>{damping_schema}, "damping of the bodies"),
      }};
  return schema;
}

constexpr QuantityKind friction{dimension::number, limits::not_negative};
constexpr QuantityKind spring{dimension::stiffness, limits::positive};

const Schema<ContactPairCase>& contact_pair_schema() {
  using P = ContactPairCase;
  static const Schema<P> schema{
      .doc = "Two bodies, or a body and itself, for which something else holds than what `[contact]` says.",
      .keys = {
          key("body", &P::body, body_name, "one of them", required),
          key("other", &P::other, NameKind{"name of a body", "plate"}, "the other one; the same for a body with itself",
              required),
          key("touch", &P::touch, WordKind{{"yes", "no", "tied"}},
              "whether they touch, pass through each other, or stay together for ever where they touch at the start"),
          key("friction", &P::friction, QuantityOrWordKind{friction, "auto"},
              "Coulomb's coefficient; automatic: that of `[contact]`", Need::optional, "0.1"),
          key("stiffness", &P::stiffness, QuantityOrWordKind{spring, "auto"}, "automatic: that of `[contact]`"),
      }};
  return schema;
}

const Schema<Case>& contact_schema() {
  static const Schema<Case> schema{
      .doc = "Contact. Every body touches every other one and itself where it folds; obstacles have keys of their own.",
      .keys = {
          key_at<Case>(
              "damping", [](auto& c) -> auto& { return c.contact.damping; },
              QuantityKind{dimension::number, {.low = 0, .high = 1}},
              "fraction of critical damping of a contact spring on its node; normal direction only", Need::optional,
              "0.05"),
          key_at<Case>(
              "friction", [](auto& c) -> auto& { return c.contact.friction; }, friction,
              "Coulomb's coefficient between bodies, sticking and sliding", Need::optional, "0.2"),
          key_at<Case>(
              "stiffness", [](auto& c) -> auto& { return c.contact.stiffness; }, QuantityOrWordKind{spring, "auto"},
              "of the contact spring at each node between bodies; automatic: that of the softer touching element"),
          key("pairs", &Case::contact_pairs, ListedKind<ContactPairCase>{contact_pair_schema}, "")}};
  return schema;
}

const Schema<MaterialCase>& material_schema() {
  using M = MaterialCase;
  static const Schema<M> schema{.doc = "A material. `law` says which other keys there are.",
                                .keys = {key("density", &M::density, QuantityKind{dimension::density, limits::positive},
                                             "mass per volume", required)},
                                .alternatives = alternatives("law", "how stress follows strain", &M::law)};
  return schema;
}

const Schema<CosineMode>& cosine_mode_schema() {
  using C = CosineMode;
  static const Schema<C> schema{
      .doc =
          "Initial velocity amplitude * cos(wave_vector . X) at the undeformed place X: a mode with a smooth solution.",
      .keys = {key("amplitude", &C::amplitude, velocity, "largest velocity", required),
               key("wave_vector", &C::wave_vector, VectorKind{{dimension::wave_number}},
                   "direction and 2 pi over wave length", required)}};
  return schema;
}

const Schema<MeshShape>& mesh_schema() {
  static const Schema<MeshShape> schema{
      .doc = "The triangles of a body. `shape` says which other keys there are.",
      .keys = {},
      .alternatives = alternatives_of<MeshShape>("shape", "what is meshed", std::identity{},
                                                 static_cast<const MeshShape*>(nullptr))};
  return schema;
}

const Schema<BodyCase>& body_schema() {
  using B = BodyCase;
  static const Schema<B> schema{
      .doc = "A body that deforms, in plane strain, or is rigid.",
      .keys = {
          key("material", &B::material, NameKind{"name of a material", "steel"}, "what it is made of", required),
          key("thickness", &B::thickness, QuantityKind{dimension::length, limits::positive}, "out of the plane"),
          key("velocity", &B::velocity, velocity, "at the start, of every node"),
          key("spin", &B::spin, QuantityKind{dimension::spin},
              "at the start, counter-clockwise about the centre of mass"),
          key("rigid", &B::rigid, YesNoKind{},
              "moves as one piece, by its own mass and inertia; its material gives the density and its contact "
              "springs"),
          key("cosine_mode", &B::cosine_mode, InlineTableKind<CosineMode>{cosine_mode_schema},
              "a velocity at the start that changes from place to place"),
          key("mesh", &B::mesh, InlineTableKind<MeshShape>{mesh_schema}, "its triangles", required),
      }};
  return schema;
}

const Schema<ObstacleCase>& obstacle_schema() {
  using O = ObstacleCase;
  static const Schema<O> schema{
      .doc = "A rigid obstacle that every body can strike. `shape` says which other keys there are.",
      .keys =
          {
              key("friction", &O::friction, friction, "Coulomb's coefficient, sticking and sliding", Need::optional,
                  "0.35"),
              key("stiffness", &O::stiffness, QuantityOrWordKind{spring, "auto"},
                  "of the contact spring at each node; automatic: that of the touching element"),
              key("tangential_stiffness", &O::tangential_stiffness, QuantityOrWordKind{spring, "auto"},
                  "of the spring that sticks before it slides; automatic: as `stiffness`"),
              key("velocity", &O::velocity, velocity, "of the obstacle, for ever"),
              key("corners", &O::corners, YesNoKind{},
                  "its corners push the boundary of a body between two nodes; false: it pushes nodes only",
                  Need::optional, "false"),
          },
      .alternatives = alternatives("shape", "its outline", &O::shape)};
  return schema;
}

const Schema<Selection>& selection_schema() {
  using S = Selection;
  static const Schema<S> schema{
      .doc = "Nodes or edges of the undeformed body, chosen in one of four ways.",
      .keys = {
          key("side", &S::side, NameKind{"name of a side", "left", true}, "a side that the mesh generator named"),
          key("box", &S::box, PointsKind{any_length, 2, 2, true},
              "two opposite corners: all that is inside or on the sides", Need::optional,
              "[[\"0 cm\", \"0 cm\"], [\"4 cm\", \"3 cm\"]]"),
          key("line", &S::line, PointsKind{any_length, 2, 2, true}, "two ends: all that is on the line"),
          key("point", &S::point, place, "the nearest node; not for edges"),
      }};
  return schema;
}

const Schema<SupportCase>& support_schema() {
  using S = SupportCase;
  struct Turning {
    Vec2 about;
    TimeTable angle;
  };
  // In the file a turn is one table; in the Case the angle is optional and stands beside its centre.
  static const Schema<Turning> turning{
      .doc = "A turn of the nodes as one rigid piece.",
      .keys = {key("about", &Turning::about, place, "centre of the turn", required),
               key("angle", &Turning::angle, TimeTableKind{{dimension::angle}}, "counter-clockwise", required)}};
  static constexpr SchemaSource<Turning> turning_schema = +[]() -> const Schema<Turning>& { return turning; };
  const InlineTableKind<Turning> kind{turning_schema};
  Key<S> turn{
      {"turn", kind.describe(), "", "turns the nodes rigidly; not together with move_x or move_y", kind.example()}};
  turn.read = [kind](const Value& value, const std::string& path, S& support, Mistakes& mistakes) {
    Turning read;
    kind.read(value, path, read, mistakes);
    support.turn = read.angle;
    support.turn_about = read.about;
  };
  turn.check = [kind](const S& support, const std::string& path, Mistakes& mistakes) {
    if (support.turn) kind.check(Turning{support.turn_about, *support.turn}, path, mistakes);
  };
  turn.write = [kind](const S& support, const std::string&) {
    return support.turn ? kind.write(Turning{support.turn_about, *support.turn}) : "";
  };
  turn.describe_below = [kind](const std::string& path, std::vector<TableText>& texts) {
    kind.describe_below(path, texts);
  };

  const TimeTableKind moved{any_length};
  static const Schema<S> schema{
      .doc = "Nodes whose motion is given. A direction that is not named stays free.",
      .keys = {
          key_at<S>(
              "body", [](auto& s) -> auto& { return s.nodes.body; }, body_name, "whose nodes", required),
          key("nodes", &S::nodes, InlineTableKind<Selection>{selection_schema}, "which of them", required,
              "{ side = \"left\" }"),
          key("move_x", &S::move_x, moved, "displacement along x; \"0 m\" holds the nodes", Need::optional, "\"0 m\""),
          key("move_y", &S::move_y, moved, "displacement along y", Need::optional, "\"0 m\""),
          turn,
      }};
  return schema;
}

/// A key that belongs to one kind of load and says that the load is of that kind.
Key<LoadCase> only_for(LoadCase::Kind kind, const Key<LoadCase>& key) {
  Key<LoadCase> out = key;
  out.read = [kind, key](const Value& value, const std::string& path, LoadCase& load, Mistakes& mistakes) {
    load.kind = kind;
    key.read(value, path, load, mistakes);
  };
  out.check = [kind, key](const LoadCase& load, const std::string& path, Mistakes& mistakes) {
    if (load.kind == kind) key.check(load, path, mistakes);
  };
  out.write = [kind, key](const LoadCase& load, const std::string& path) {
    return load.kind == kind ? key.write(load, path) : "";
  };
  out.text.standard = "";
  return out;
}

/// `nodes` and `edges` fill the same member; which of them a case file has is settled by the kind of load.
Key<LoadCase> selected(const std::string& name, bool nodes, const std::string& doc) {
  using L = LoadCase;
  Key<L> out = key(name, &L::where, InlineTableKind<Selection>{selection_schema}, doc, Need::optional,
                   nodes ? "{ point = [\"4 cm\", \"3 cm\"] }" : "{ side = \"top\" }");
  const auto mine = [nodes](const L& load) { return nodes == (load.kind == L::Kind::force); };
  out.check = [mine, check = out.check](const L& load, const std::string& path, Mistakes& mistakes) {
    if (mine(load)) check(load, path, mistakes);
  };
  out.write = [mine, write = out.write](const L& load, const std::string& path) {
    return mine(load) ? write(load, path) : "";
  };
  out.text.standard = "";
  if (!nodes) out.describe_below = nullptr;  // the same table as that of the nodes
  return out;
}

const Schema<LoadCase>& load_schema() {
  using L = LoadCase;
  static const Schema<L> schema{
      .doc = "A force on nodes, or a traction or a pressure on edges.",
      .keys =
          {
              key_at<L>(
                  "body", [](auto& l) -> auto& { return l.where.body; }, body_name, "on which it acts", required),
              selected("nodes", true, "where a force acts"),
              selected("edges", false, "where a traction or a pressure acts"),
              only_for(L::Kind::force, key("force", &L::value, VectorKind{{dimension::force}}, "at each node")),
              only_for(L::Kind::traction, key("traction", &L::value, VectorKind{{dimension::stress}},
                                              "force per undeformed area, in a direction that stays", Need::optional,
                                              "[\"0 Pa\", \"-2 MPa\"]")),
              only_for(L::Kind::pressure,
                       key("pressure", &L::pressure, QuantityKind{dimension::stress},
                           "force per deformed area, along the inward normal", Need::optional, "\"2 MPa\"")),
              key("factor", &L::factor, TimeTableKind{{dimension::number}}, "multiplies the load"),
          },
      .one_of = {{"force", "traction", "pressure"}, {"nodes", "edges"}},
      .clashes = {{"edges", "force", "a force acts on nodes", "write nodes = { ... }"},
                  {"nodes", "traction", "a traction acts on edges", "write edges = { ... }"},
                  {"nodes", "pressure", "a pressure acts on edges", "write edges = { ... }"}}};
  return schema;
}

template <class Observer>
Schema<Observer> observer_schema(const std::string& doc, Key<Observer> where) {
  return {.doc = doc,
          .keys = {key("name", &Observer::name, own_name, "what the results call it; each name once", required),
                   key("body", &Observer::body, body_name, "where it is", required), std::move(where),
                   key("window", &Observer::window, WindowKind{}, "when extremes are taken")}};
}

const Schema<NodeObserverCase>& node_observer_schema() {
  using N = NodeObserverCase;
  static const Schema<N> schema = observer_schema<N>(
      "A node whose motion is recorded.", key("at", &N::at, place, "the nearest node, undeformed", required));
  return schema;
}

const Schema<ElementObserverCase>& element_observer_schema() {
  using E = ElementObserverCase;
  static const Schema<E> schema = observer_schema<E>("An element whose stresses are recorded.",
                                                     key("at", &E::at, place, "a point in it, undeformed", required));
  return schema;
}

const Schema<RegionObserverCase>& region_observer_schema() {
  using R = RegionObserverCase;
  static const Schema<R> schema = observer_schema<R>(
      "A part of a body whose mean motion is recorded.",
      key("polygon", &R::polygon, PointsKind{any_length, 3}, "all nodes inside it at the start", required));
  return schema;
}

const Schema<Case>& observe_schema() {
  static const Schema<Case> schema{
      .keys = {key("nodes", &Case::observed_nodes, ListedKind<NodeObserverCase>{node_observer_schema}, ""),
               key("elements", &Case::observed_elements, ListedKind<ElementObserverCase>{element_observer_schema}, ""),
               key("regions", &Case::observed_regions, ListedKind<RegionObserverCase>{region_observer_schema}, "")}};
  return schema;
}

const Schema<OutputCase>& output_schema() {
  using O = OutputCase;
  static const Schema<O> schema{
      .doc = "When results are written.",
      .keys = {
          key("fields_every", &O::fields_every, QuantityOrWordKind{positive_time, "never"},
              "from one picture of all fields to the next", Need::optional, "\"20 us\""),
          key("fields_at", &O::fields_at, ListKind{{dimension::time, limits::not_negative}},
              "pictures at these times as well", Need::optional, "[\"0.52 ms\"]"),
          key("histories_every", &O::histories_every, QuantityOrWordKind{positive_time, "auto"},
              "from one line of the histories to the next; automatic: a thousandth of the run", Need::optional,
              "\"1 us\""),
          key("report", &O::report, YesNoKind{},
              "`udar run` leaves `report.html`, one page that shows the run in a browser"),
          key("checkpoint", &O::checkpoint, QuantityOrWordKind{positive_time, "never"},
              "wall time from one checkpoint to the next; `udar resume` goes on from the last one", Need::optional,
              "\"60 s\""),
      }};
  return schema;
}

}  // namespace

const Schema<Case>& case_schema() {
  static const Schema<Case> schema{.keys = {
                                       key("run", &Case::run, SectionKind<RunSettings>{run_schema}, "", required),
                                       key_at<Case>("contact", std::identity{}, SectionKind<Case>{contact_schema}, ""),
                                       key("materials", &Case::materials, NamedKind<MaterialCase>{material_schema}, ""),
                                       key("bodies", &Case::bodies, NamedKind<BodyCase>{body_schema}, ""),
                                       key("obstacles", &Case::obstacles, NamedKind<ObstacleCase>{obstacle_schema}, ""),
                                       key("supports", &Case::supports, NamedKind<SupportCase>{support_schema}, ""),
                                       key("loads", &Case::loads, NamedKind<LoadCase>{load_schema}, ""),
                                       key_at<Case>("observe", std::identity{}, SectionKind<Case>{observe_schema}, ""),
                                       key("output", &Case::output, SectionKind<OutputCase>{output_schema}, ""),
                                   }};
  return schema;
}

}  // namespace udar
