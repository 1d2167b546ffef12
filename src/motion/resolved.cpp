#include "bough/motion/resolved.hpp"

#include <stdexcept>
#include <string>

namespace bough::motion {

namespace {

void require_same_axes(int a, int b, const char* what) {
  if (a != b)
    throw std::invalid_argument(std::string(what) + ": one vector is resolved in frame " + std::to_string(a) +
                                ", the other in frame " + std::to_string(b) + "; resolve both in one frame first");
}

}  // namespace

const Vec3<double>& Resolved::components(In axes) const {
  if (axes.frame != axes_)
    throw std::invalid_argument("components: the vector is resolved in frame " + std::to_string(axes_) +
                                ", not in frame " + std::to_string(axes.frame));
  return components_;
}

Resolved& Resolved::operator+=(const Resolved& b) {
  require_same_axes(axes_, b.axes_, "sum");
  components_ += b.components_;
  return *this;
}

Resolved& Resolved::operator-=(const Resolved& b) {
  require_same_axes(axes_, b.axes_, "difference");
  components_ -= b.components_;
  return *this;
}

Resolved cross(const Resolved& a, const Resolved& b) {
  require_same_axes(a.axes_, b.axes_, "vector product");
  return {cross(a.components_, b.components_), a.axes()};
}

double dot(const Resolved& a, const Resolved& b) {
  require_same_axes(a.axes_, b.axes_, "scalar product");
  return dot(a.components_, b.components_);
}

double norm(const Resolved& a) { return std::hypot(a.components_[0], a.components_[1], a.components_[2]); }

const Resolved& Rate::value(From observer) const {
  if (observer.frame != observer_)
    throw std::invalid_argument("rate: the derivative is taken from frame " + std::to_string(observer_) +
                                ", not from frame " + std::to_string(observer.frame));
  return value_;
}

}  // namespace bough::motion
