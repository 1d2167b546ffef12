#include "lanes_impl.hpp"

namespace bough::elements::planar {

BOUGH_INSTANTIATE_PLANAR(Beam<3>)
BOUGH_INSTANTIATE_PLANAR(LineLoad<3>)

}  // namespace bough::elements::planar
