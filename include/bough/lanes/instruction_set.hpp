#pragma once
/// The instruction set that the loaded library was compiled for. With BOUGH_DISPATCH the loader gives a program, itself
/// compiled once, the library that suits the processor. Therefore the library reports it: preprocessor macros of the
/// program would describe the build of the program.
#include <string_view>

namespace bough::lanes {

struct InstructionSet {
  std::string_view name;     ///< "AVX-512", "AVX2", "AVX" or "SSE2"
  int register_doubles = 1;  ///< number of doubles that one register of a kernel holds
};

InstructionSet instruction_set();

}  // namespace bough::lanes
