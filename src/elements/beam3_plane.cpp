#include "lanes_impl.hpp"

namespace bough::elements {

using Beam3InPlane = BeamOn<motion::Se2, 3>;
using LineLoad3InPlane = LineLoadOn<motion::Se2, 3>;
BOUGH_INSTANTIATE_BOTH(Beam3InPlane)
BOUGH_INSTANTIATE_BOTH(LineLoad3InPlane)

}  // namespace bough::elements
