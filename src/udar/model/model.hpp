#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "udar/base/array.hpp"
#include "udar/base/time_table.hpp"
#include "udar/contact/foot.hpp"
#include "udar/contact/shapes.hpp"
#include "udar/contact/tie.hpp"
#include "udar/material/laws.hpp"
#include "udar/mesh/blocks.hpp"
#include "udar/model/settings.hpp"

namespace udar {

/// Everything that does not change during a run. Const once built; SI units throughout.

/// One body: a run of nodes and a run of elements with one law. Element arrays are padded to whole vectors: elements
/// from `element_end` to `padded_end` are triangles of the padding nodes, which never move and carry no mass.
struct Body {
  std::string name;
  Law law = Elastic{};
  double density = 0;    ///< kg/m3
  double thickness = 0;  ///< m
  Index node_begin = 0;
  Index node_end = 0;
  Index element_begin = 0;
  Index element_end = 0;
  Index padded_end = 0;
  double mass = 0;  ///< kg
  bool rigid = false;
  std::vector<Edge> boundary;
  std::vector<NamedEdges> sides;
};

/// A stretch of nodes of one body.
struct NodeBlock {
  Index begin = 0;
  Index end = 0;
  Index body = 0;
};

/// A body that moves as one piece. Its elements have no stress and are in no block.
struct RigidBody {
  Index body = 0;
  std::size_t block_begin = 0;  ///< in Model::node_blocks
  std::size_t block_end = 0;
  Vec2 centre{};          ///< m, of mass, at rest
  double mass = 0;        ///< kg
  double inertia = 0;     ///< kg m2, of its area about the centre
  Vec2 start_velocity{};  ///< m/s
  double start_spin = 0;  ///< rad/s
  double springs = 0;     ///< 1/s2: what all springs that may touch it add to its frequency^2
  double dashpots = 0;    ///< 1/s, the same of their dashpots

  /// 1 / kg: what a spring at `place` (m, at rest) moves of the body at most, 1 / mass + arm^2 / inertia.
  [[nodiscard]] double inverse_mass_at(Vec2 place) const {
    return 1 / mass + dot(place - centre, place - centre) / inertia;
  }
};

inline constexpr Index padding_nodes = 3;  ///< corners of the padding triangle, after the last node

/// A rigid obstacle and the springs between it and the nodes that may touch it.
struct Obstacle {
  std::string name;
  Shape shape;
  PreparedShape prepared;
  Box bounds;               ///< m, holds the obstacle where it stands at t = 0
  double inner_radius = 0;  ///< m, no point in it is deeper
  double friction = 0;
  Vec2 velocity{};  ///< m/s
  /// N/m, one for each of Model::contact_nodes.
  std::vector<double> normal_stiffness;
  std::vector<double> tangential_stiffness;
};

/// A corner of an obstacle, which may dig into the boundary of a body between two of its nodes.
struct ObstacleCorner {
  std::uint32_t obstacle = 0;
  Vec2 place{};        ///< m, at t = 0
  Vec2 normal{};       ///< unit vector, the mean of those of its two faces
  double stretch = 0;  ///< m, half of its two faces
};

/// Stiffnesses of the springs of a touch, N/m.
struct TouchStiffness {
  double normal = 0;
  double tangential = 0;
};

/// What holds between two bodies, or within one.
struct BodyPair {
  bool touch = true;
  double friction = 0;
  std::optional<double> stiffness;  ///< N/m, of each spring; none: automatic
  bool tied = false;                ///< where they touch at the start they stay together
};

/// What holds between which bodies: the same for nearly all pairs. A table of all of them would grow with the square of
/// the number of bodies.
struct BodyPairs {
  struct Exception {
    Index first = 0;  ///< body, not above `second`
    Index second = 0;
    BodyPair pair;
  };
  BodyPair usual;
  std::vector<Exception> exceptions;  ///< in the order of first, then second

  /// Of two bodies in either order, or of a body with itself.
  [[nodiscard]] const BodyPair& of(Index a, Index b) const { return exceptions.empty() ? usual : look_up(a, b); }
  /// Makes an exception; of two for the same pair the later one holds.
  void set(Index a, Index b, const BodyPair& pair);

 private:
  [[nodiscard]] const BodyPair& look_up(Index a, Index b) const;
};

/// Nodes whose motion is given. Directions not held stay free.
struct Support {
  std::string name;
  Index body = 0;
  std::vector<Index> nodes;
  bool holds_x = false;
  bool holds_y = false;
  bool turns = false;  ///< rigidly about `centre`; then x and y are both held
  TimeTable move_x;    ///< m
  TimeTable move_y;    ///< m
  TimeTable turn;      ///< rad
  Vec2 centre{};       ///< m
};

/// Forces at nodes: `value` times `share` at each (constant direction), or a pressure on edges that turns with them.
struct Load {
  std::string name;
  std::vector<Index> nodes;
  std::vector<double> shares;  ///< 1 at each node of a force; area (m2) of a traction
  std::vector<Edge> edges;     ///< of a pressure; nodes[2 k], nodes[2 k + 1] are the ends of edge k
  Vec2 value{};                ///< N, or Pa
  double pressure = 0;         ///< Pa
  double thickness = 0;        ///< m
  TimeTable factor;
};

/// When extremes are taken.
struct ObserverWindow {
  double begin = 0;  ///< s
  double end = 0;    ///< s
};

struct NodeObserver {
  std::string name;
  Index node = 0;
  ObserverWindow window;
};

struct ElementObserver {
  std::string name;
  Index element = 0;
  ObserverWindow window;
};

struct RegionObserver {
  std::string name;
  std::vector<Index> nodes;
  double mass = 0;  ///< kg
  ObserverWindow window;
};

struct OutputSettings {
  double fields_every = 0;  ///< s; 0: only fields_at
  std::vector<double> fields_at;
  double histories_every = 0;  ///< s
};

struct Model {
  RunSettings run;
  ContactSettings contact;
  std::vector<Body> bodies;
  std::vector<RigidBody> rigid_bodies;
  std::vector<ElementBlock> element_blocks;  ///< of bodies that deform
  std::vector<NodeBlock> node_blocks;        ///< of all bodies

  // Nodes, then the padding nodes.
  Index node_count = 0;
  std::vector<Vec2> rest;            ///< m, undeformed places
  std::vector<Vec2> start_velocity;  ///< m/s
  Array<double> mass;                ///< kg
  Array<double> inverse_mass;        ///< 1/kg
  std::vector<Index> node_numbers;   ///< the user's numbers, from 0 in each body

  // Elements, padded.
  Index element_count = 0;  ///< without padding
  std::vector<std::array<Index, 3>> corners;
  Array<Quad> quads;                   ///< the same corners as the element sweep reads them, block by block
  Array<double> area_density;          ///< kg/m: density x undeformed area, constant since masses are
  Array<double> contact_spring;        ///< 1/s2: what contact springs at its nodes add to an element's frequency^2
  std::vector<Index> element_numbers;  ///< the user's numbers

  // Contact: the outer nodes of all bodies may touch every obstacle.
  std::vector<Index> contact_nodes;
  std::vector<double> contact_node_sizes;  ///< m, mean length of the two boundary edges at the node
  std::vector<Obstacle> obstacles;

  // Contact of bodies with each other and with themselves, and of obstacles' corners with them. Points are counted as
  // contact_nodes, then obstacle_corners; where nothing may touch, there are no segments.
  std::vector<ObstacleCorner> obstacle_corners;
  std::vector<Index> contact_bodies;        ///< body of each contact node
  std::vector<double> contact_stiffness;    ///< N/m, of the elements at each contact node
  std::vector<Segment> segments;            ///< body by body
  std::vector<std::uint32_t> segment_from;  ///< the segment that begins in each contact node
  std::vector<double> segment_softness;     ///< N/m2, stiffness of the element at each segment for its length
  /// 1/s2: part of contact_spring of the elements at each contact node that is there for touches of bodies. A spring k
  /// between points with shares g (1 for one side, 1 in all for the other one) adds at most k |g| (sum of all |g|) / m
  /// at each: (sum g x)^2 <= (sum |g|) (sum |g| x^2).
  std::vector<double> contact_allowance;
  BodyPairs body_pairs;
  std::vector<Tie> ties;      ///< in the order of points
  double contact_margin = 0;  ///< m, how much farther than it must the list of near segments looks

  std::vector<Support> supports;
  std::vector<Load> loads;

  std::vector<NodeObserver> observed_nodes;
  std::vector<ElementObserver> observed_elements;
  std::vector<RegionObserver> observed_regions;
  OutputSettings output;

  /// What holds between the body of a contact node and a body.
  [[nodiscard]] const BodyPair& body_pair(std::uint32_t point, Index body) const {
    return body_pairs.of(contact_bodies[point], body);
  }
  [[nodiscard]] std::size_t point_count() const { return contact_nodes.size() + obstacle_corners.size(); }
  [[nodiscard]] bool is_obstacle_corner(std::uint32_t point) const { return point >= contact_nodes.size(); }
  [[nodiscard]] const ObstacleCorner& corner_of(std::uint32_t point) const {
    return obstacle_corners[point - contact_nodes.size()];
  }
  [[nodiscard]] const Obstacle& obstacle_of(std::uint32_t point) const { return obstacles[corner_of(point).obstacle]; }
  /// Is a point tied to the boundary of a body?
  [[nodiscard]] bool is_tied(std::uint32_t point, Index body) const;
  /// Of the springs between a point and a place on a segment. Between bodies what was given, or half that of the softer
  /// side on the node's stretch of boundary, since the other side's nodes bring the other half. At a corner of an
  /// obstacle those of the obstacle's springs at the ends of the segment, less where its faces are shorter than that.
  [[nodiscard]] TouchStiffness touch_stiffness(std::uint32_t point, std::uint32_t segment, double along) const;
  [[nodiscard]] const Body& body_of_element(Index element) const;
  [[nodiscard]] const Body& body_of_node(Index node) const;
};

}  // namespace udar
