#pragma once
#include <string>

namespace bough::step {

/// Why a step or a run cannot go on, in words for the user.
struct Trouble {
  std::string text;
};

}  // namespace bough::step
