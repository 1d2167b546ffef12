#include "lanes_impl.hpp"

namespace bough::elements::planar {

BOUGH_INSTANTIATE_PLANAR(Beam<2>)
BOUGH_INSTANTIATE_PLANAR(LineLoad<2>)

}  // namespace bough::elements::planar
