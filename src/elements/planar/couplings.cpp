#include "lanes_impl.hpp"

namespace bough::elements::planar {

int list_laws(const Joint& e, int* laws) {
  int n = 0;
  for (int k = 0; k < e.num_rows; ++k)
    if (e.rows[k].law >= 0) laws[n++] = e.rows[k].law;
  for (int k = 0; k < e.num_efforts; ++k)
    if (e.efforts[k].effort.law >= 0) laws[n++] = e.efforts[k].effort.law;
  return n;
}

int list_laws(const PointLoad& e, int* laws) {
  laws[0] = e.law;
  return 1;
}

BOUGH_INSTANTIATE_PLANAR(RigidBody)
BOUGH_INSTANTIATE_PLANAR(PointLoad)
BOUGH_INSTANTIATE_PLANAR(Spring)
BOUGH_INSTANTIATE_PLANAR(Bushing)
BOUGH_INSTANTIATE_PLANAR(Joint)

}  // namespace bough::elements::planar
