#pragma once
/// What the library that is loaded was compiled for. Asked of the library, since a program compiled once may be given
/// libraries of several instruction sets by the loader (BOUGH_DISPATCH): its own macros would tell what the program
/// was compiled for.
#include <string_view>

namespace bough::lanes {

struct InstructionSet {
  std::string_view name;     ///< "AVX-512", "AVX2", "AVX" or "SSE2"
  int register_doubles = 1;  ///< that one register of a kernel holds
};

InstructionSet instruction_set();

}  // namespace bough::lanes
