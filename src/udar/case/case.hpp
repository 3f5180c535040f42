#pragma once

#include <optional>
#include <string>
#include <vector>

#include "udar/base/time_table.hpp"
#include "udar/contact/shapes.hpp"
#include "udar/material/laws.hpp"
#include "udar/mesh/generators.hpp"
#include "udar/model/settings.hpp"

namespace udar {

/// A case as the user describes it, in SI units: what a case file says, or what a program builds in code with
/// designated initialisers. `build_model` turns it into a Model.

struct MaterialCase {
  std::string name;
  double density = 0;  ///< kg/m3
  Law law = Elastic{};
};

/// Initial velocity amplitude * cos(wave_vector . X): a mode with a smooth exact solution.
struct CosineMode {
  Vec2 amplitude{};    ///< m/s
  Vec2 wave_vector{};  ///< rad/m
};

struct BodyCase {
  std::string name;
  std::string material;
  double thickness = 1;  ///< m
  Vec2 velocity{};       ///< m/s
  double spin = 0;       ///< rad/s, counter-clockwise about the centre of mass
  bool rigid = false;    ///< moves as one piece, by its own mass and inertia
  std::optional<CosineMode> cosine_mode;
  MeshShape mesh = RectangleMesh{};
};

struct ObstacleCase {
  std::string name;
  Shape shape = HalfPlane{};
  double friction = 0;
  std::optional<double> stiffness;             ///< N/m at each node; none: from the touching element
  std::optional<double> tangential_stiffness;  ///< N/m; none: as `stiffness`
  Vec2 velocity{};                             ///< m/s, for ever
  bool corners = true;                         ///< they push boundaries between nodes, too
};

/// Nodes or edges of a body; exactly one of the four ways. Places are those of the undeformed body.
struct Selection {
  std::string body;
  std::string side;           ///< a named piece of boundary: "left"
  std::vector<Vec2> box;      ///< m, two opposite corners: all inside or on them
  std::vector<Vec2> line;     ///< m, two ends: all within a hundredth of an element of it
  std::optional<Vec2> point;  ///< m, the nearest node (not for edges)
};

/// Nodes whose motion is given. Directions not named stay free.
struct SupportCase {
  std::string name;
  Selection nodes;
  std::optional<TimeTable> move_x;  ///< m, displacement; constant 0: held
  std::optional<TimeTable> move_y;  ///< m
  std::optional<TimeTable> turn;    ///< rad, rigidly about `turn_about`; not together with move_x or move_y
  Vec2 turn_about{};                ///< m
};

struct LoadCase {
  std::string name;
  enum class Kind { force, traction, pressure } kind = Kind::force;
  Selection where;      ///< nodes for a force, edges for a traction or a pressure
  Vec2 value{};         ///< N at each node, or Pa on the undeformed edge (constant direction)
  double pressure = 0;  ///< Pa on the deformed edge, along its inward normal
  TimeTable factor = TimeTable::constant(1);
};

/// What holds between two bodies, or within one, where it is not what [contact] says.
struct ContactPairCase {
  std::string body;
  std::string other;
  enum class Touch { yes, no, tied } touch = Touch::yes;
  std::optional<double> friction;
  std::optional<double> stiffness;  ///< N/m
};

/// From when to when minima and maxima are taken.
struct Window {
  double begin = 0;  ///< s
  double end = std::numeric_limits<double>::infinity();
};

struct NodeObserverCase {
  std::string name;
  std::string body;
  Vec2 at{};  ///< m; the nearest node of the undeformed body
  Window window;
};

/// The element that contains `at`; on an edge the candidate whose undeformed centroid has the smaller x, then y.
struct ElementObserverCase {
  std::string name;
  std::string body;
  Vec2 at{};  ///< m
  Window window;
};

/// Nodes inside a polygon at t = 0, with their full masses.
struct RegionObserverCase {
  std::string name;
  std::string body;
  std::vector<Vec2> polygon;  ///< m
  Window window;
};

struct OutputCase {
  std::optional<double> fields_every;     ///< s
  std::vector<double> fields_at;          ///< s
  std::optional<double> histories_every;  ///< s; none: a thousandth of the run
  bool report = true;                     ///< report.html at the end of `udar run`
  std::optional<double> checkpoint = 60;  ///< s of wall time between two checkpoints; none: there are none
};

struct Case {
  RunSettings run;
  ContactSettings contact;
  std::vector<ContactPairCase> contact_pairs;
  std::vector<MaterialCase> materials;
  std::vector<BodyCase> bodies;
  std::vector<ObstacleCase> obstacles;
  std::vector<SupportCase> supports;
  std::vector<LoadCase> loads;
  std::vector<NodeObserverCase> observed_nodes;
  std::vector<ElementObserverCase> observed_elements;
  std::vector<RegionObserverCase> observed_regions;
  OutputCase output;
};

}  // namespace udar
