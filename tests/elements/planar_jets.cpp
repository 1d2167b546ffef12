#include "elements/planar_jets.hpp"

#include "../../src/elements/planar/evaluate_impl.hpp"

namespace bough::elements::check {

template <int N>
void eval_tangent_on_jets(const planar::Beam<N>& beam, const planar::Field& field, double* tangent) {
  planar::eval_tangent_on_jets<planar::Beam<N>, double>(beam, field, nullptr, 0.0, tangent);
}
template void eval_tangent_on_jets(const planar::Beam<2>&, const planar::Field&, double*);
template void eval_tangent_on_jets(const planar::Beam<3>&, const planar::Field&, double*);
template void eval_tangent_on_jets(const planar::Beam<4>&, const planar::Field&, double*);

}  // namespace bough::elements::check
