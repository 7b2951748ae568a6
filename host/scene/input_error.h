#pragma once

#include <stdexcept>

namespace coppice {

// Bad input from the user, never a fault of the program: a file that is missing or malformed, a name that
// nothing answers to, an output that cannot be written. what() is one line that names the file (and the line
// number, where there is one) and says what is wrong with it.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace coppice
