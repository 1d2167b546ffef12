#include "evaluate_impl.hpp"

namespace bough::elements {

BOUGH_INSTANTIATE_ELEMENT(Joint)

}  // namespace bough::elements
