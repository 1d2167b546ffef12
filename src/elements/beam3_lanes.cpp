#include "lanes_impl.hpp"

namespace bough::elements {

BOUGH_INSTANTIATE_LANES(Beam<3>)
BOUGH_INSTANTIATE_LANES(LineLoad<3>)

}  // namespace bough::elements
