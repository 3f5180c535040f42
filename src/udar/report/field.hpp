#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "udar/results/run_frames.hpp"

namespace udar {

/// Something that a picture of a frame can show.
struct FieldKind {
  enum class Of {
    elements,   ///< a number for each element
    x,          ///< of the vector at each node
    y,          ///< of the vector at each node
    size,       ///< of the vector at each node
    flow,       ///< elements that flow now, and those that have flowed
    contact,    ///< arrows at nodes
    no_values,  ///< the bodies alone
  };
  std::string_view name;        ///< as histories call it: "principal_1"
  std::string_view short_name;  ///< as people type it: "sigma1"; may be empty
  std::string_view caption;     ///< "first principal stress"
  std::string_view array;       ///< in the VTU file
  std::string_view unit;        ///< SI
  Of of = Of::elements;

  [[nodiscard]] bool has_values() const { return of != Of::flow && of != Of::contact && of != Of::no_values; }
};

/// Every kind, in the order of the help.
std::span<const FieldKind> field_kinds();

/// The kind with this name or short name. Throws UserError (usage) with the names there are, or the one that was meant.
const FieldKind& find_field(std::string_view name);

/// One number for each triangle, SI; of nodes the mean of the corners. Throws OutputError where the frame lacks it.
std::vector<double> element_values(const Frame& frame, const FieldKind& kind);

/// One number for each node, SI; of elements the mean of those round it.
std::vector<double> node_values(const Frame& frame, const FieldKind& kind);

/// For each triangle 1 where it flows now, 2 where it has flowed before, else 0.
std::vector<std::uint8_t> flow_flags(const Frame& frame);

/// The vectors at the nodes in the array of this name, SI. Throws OutputError where the frame lacks it.
std::vector<Vec2> node_vectors(const Frame& frame, std::string_view name);

/// Number of the body of each triangle.
std::vector<std::int32_t> bodies_of_triangles(const Frame& frame);

}  // namespace udar
