#pragma once

#include <variant>

#include "udar/material/elastic.hpp"
#include "udar/material/tresca.hpp"

namespace udar {

/// Every material law. A new one is added here and nowhere else.
using Law = std::variant<Elastic, Tresca>;

}  // namespace udar
