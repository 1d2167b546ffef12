#include "lanes_impl.hpp"

namespace bough::elements {

int list_laws(const Joint& e, int* laws) {
  int n = 0;
  for (int k = 0; k < e.num_rows; ++k)
    if (e.rows[k].law >= 0) laws[n++] = e.rows[k].law;
  for (int k = 0; k < e.num_efforts; ++k)
    if (e.efforts[k].law >= 0) laws[n++] = e.efforts[k].law;
  return n;
}

int list_laws(const PointLoad& e, int* laws) {
  laws[0] = e.law;
  return 1;
}

BOUGH_INSTANTIATE_LANES(RigidBody)
BOUGH_INSTANTIATE_LANES(PointLoad)
BOUGH_INSTANTIATE_LANES(Spring)
BOUGH_INSTANTIATE_LANES(Bushing)
BOUGH_INSTANTIATE_LANES(Joint)

}  // namespace bough::elements
