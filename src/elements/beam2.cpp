#include "evaluate_impl.hpp"

namespace bough::elements {

BOUGH_INSTANTIATE_ELEMENT(Beam<2>)
BOUGH_INSTANTIATE_ELEMENT(LineLoad<2>)

}  // namespace bough::elements
