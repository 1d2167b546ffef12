#include "lanes_impl.hpp"

namespace bough::elements::planar {

BOUGH_INSTANTIATE_PLANAR(Beam<4>)
BOUGH_INSTANTIATE_PLANAR(LineLoad<4>)

}  // namespace bough::elements::planar
