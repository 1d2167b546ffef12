#include "lanes_impl.hpp"

namespace bough::elements {

BOUGH_INSTANTIATE_LANES(Beam<2>)
BOUGH_INSTANTIATE_LANES(Beam<3>)
BOUGH_INSTANTIATE_LANES(Beam<4>)
BOUGH_INSTANTIATE_LANES(LineLoad<2>)
BOUGH_INSTANTIATE_LANES(LineLoad<3>)
BOUGH_INSTANTIATE_LANES(LineLoad<4>)

}  // namespace bough::elements
