#include "lanes_impl.hpp"

namespace bough::elements {

using Beam4InPlane = BeamOn<motion::Se2, 4>;
using LineLoad4InPlane = LineLoadOn<motion::Se2, 4>;
BOUGH_INSTANTIATE_BOTH(Beam4InPlane)
BOUGH_INSTANTIATE_BOTH(LineLoad4InPlane)

}  // namespace bough::elements
