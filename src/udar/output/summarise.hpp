#pragma once

#include "udar/model/model.hpp"
#include "udar/model/state.hpp"
#include "udar/results/summary.hpp"

namespace udar {

/// What the state itself tells of a run: counts, books, time steps, verdict. Histories, contacts, wall time and the
/// reason of the stop are added by the run.
Summary summarise(const Model& model, const State& state);

/// Judges a run from its numbers and from what stopped it: verdict, reasons and warnings. Reasons already there stay.
void judge(const Model& model, const State& state, Summary& summary);

/// "beam element 1873", with the number the user's mesh gave it.
std::string element_name(const Model& model, Index element);
/// "beam node 96", the same way.
std::string node_name(const Model& model, Index node);

}  // namespace udar
