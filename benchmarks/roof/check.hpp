#pragma once

namespace roof {

/// Does the roof compute the same impact as the program? Prints what it finds; true if so.
bool check_against_program();

}  // namespace roof
