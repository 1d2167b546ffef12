#include "lanes_impl.hpp"

namespace bough::elements {

BOUGH_INSTANTIATE_LANES(Beam<4>)
BOUGH_INSTANTIATE_LANES(LineLoad<4>)

}  // namespace bough::elements
