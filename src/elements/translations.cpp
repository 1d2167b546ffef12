#include "lanes_impl.hpp"

namespace bough::elements {

template <int N, class G = motion::Translations<N>>
using ElementsOfPoints = std::tuple<RigidBodyOn<G>, PointLoadOn<G>, JointOn<G>>;
BOUGH_EMIT(both_drivers, _of_places, ElementsOfPoints<3>)
BOUGH_EMIT(both_drivers, _on_line, ElementsOfPoints<1>)

}  // namespace bough::elements
