#pragma once
/// What the running program was linked from.
#include <string>

namespace bough::io {

/// Hash of the build IDs that the linker gave the program and its libraries of bough: equal for equal builds. Empty
/// where there are none.
std::string program_hash();

}  // namespace bough::io
