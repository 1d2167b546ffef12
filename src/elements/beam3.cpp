#include "evaluate_impl.hpp"

namespace bough::elements {

BOUGH_INSTANTIATE_ELEMENT(Beam<3>)
BOUGH_INSTANTIATE_ELEMENT(LineLoad<3>)

}  // namespace bough::elements
