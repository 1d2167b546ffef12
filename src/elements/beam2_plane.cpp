#include "lanes_impl.hpp"

namespace bough::elements {

using Beam2InPlane = BeamOn<motion::Se2, 2>;
using LineLoad2InPlane = LineLoadOn<motion::Se2, 2>;
BOUGH_INSTANTIATE_BOTH(Beam2InPlane)
BOUGH_INSTANTIATE_BOTH(LineLoad2InPlane)

}  // namespace bough::elements
