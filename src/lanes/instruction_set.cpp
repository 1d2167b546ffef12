#include "bough/lanes/instruction_set.hpp"

#include "bough/lanes/pack.hpp"

namespace bough::lanes {

InstructionSet instruction_set() {
#if defined(__AVX512F__)
  constexpr std::string_view name = "AVX-512";
#elif defined(__AVX2__)
  constexpr std::string_view name = "AVX2";
#elif defined(__AVX__)
  constexpr std::string_view name = "AVX";
#else
  constexpr std::string_view name = "SSE2";
#endif
  return {name, lanes::register_doubles};
}

}  // namespace bough::lanes
