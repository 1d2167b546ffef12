#pragma once
/// The conditions of a measurement, for the context in the JSON.
#include <string>

namespace bough::bench {

/// Adds commit, compiler, flags, instruction set and BLAS to the context of Google Benchmark, and sets the BLAS to one
/// thread per call.
void add_context();

/// Threads of one call of the BLAS, if the loaded one is OpenBLAS.
void set_blas_threads(int threads);
/// Name and threads of the BLAS that was loaded; "none" if no solver needs one.
std::string describe_blas();

}  // namespace bough::bench
