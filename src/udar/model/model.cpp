#include "udar/model/model.hpp"

#include <algorithm>

namespace udar {

const Body& Model::body_of_element(Index element) const {
  return *std::find_if(bodies.begin(), bodies.end(), [=](const Body& b) { return element < b.padded_end; });
}

const Body& Model::body_of_node(Index node) const {
  return *std::find_if(bodies.begin(), bodies.end(), [=](const Body& b) { return node < b.node_end; });
}

}  // namespace udar
