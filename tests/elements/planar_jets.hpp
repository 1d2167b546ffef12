#pragma once
/// Tangents of planar beams from their residual's own source run on jets, which the library does for other elements. In a file of its
/// own: a test that saw the library's templates would instantiate the rest of them anew instead of calling the library.
#include "bough/elements/planar/evaluate.hpp"

namespace bough::elements::check {

template <int N>
void eval_tangent_on_jets(const planar::Beam<N>& beam, const planar::Field& field, double* tangent);

}  // namespace bough::elements::check
