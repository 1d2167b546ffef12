#include "lanes_impl.hpp"

namespace bough::elements {

#define BOUGH_INSTANTIATE_TRANSLATIONS(N)                      \
  BOUGH_INSTANTIATE_BOTH(RigidBodyOn<motion::Translations<N>>) \
  BOUGH_INSTANTIATE_BOTH(PointLoadOn<motion::Translations<N>>) \
  BOUGH_INSTANTIATE_BOTH(JointOn<motion::Translations<N>>)
BOUGH_INSTANTIATE_TRANSLATIONS(3)
BOUGH_INSTANTIATE_TRANSLATIONS(1)

}  // namespace bough::elements
