#include "evaluate_impl.hpp"

namespace bough::elements {

BOUGH_INSTANTIATE_ELEMENT(Beam<4>)
BOUGH_INSTANTIATE_ELEMENT(LineLoad<4>)

}  // namespace bough::elements
