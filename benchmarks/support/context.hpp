#pragma once
/// What a measurement was made with, for the JSON's context.
#include <string>

namespace bough::bench {

/// Adds commit, compiler, flags, instruction set and BLAS to the context of Google Benchmark, and sets the BLAS to
/// one thread a call.
void add_context();
/// Name and threads of the BLAS that was loaded; "none" where no solver needs one.
std::string describe_blas();

}  // namespace bough::bench
