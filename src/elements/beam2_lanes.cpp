#include "lanes_impl.hpp"

namespace bough::elements {

BOUGH_INSTANTIATE_LANES(Beam<2>)
BOUGH_INSTANTIATE_LANES(LineLoad<2>)

}  // namespace bough::elements
