#include "bough/step/between.hpp"

#include "bough/motion/group.hpp"

namespace bough::step {

using motion::Se3;
using motion::Vec6;

void eval_between(const elements::NodeMotion& first, const elements::NodeMotion& last, double h, double part,
                  elements::NodeMotion& out) {
  const motion::Frame<double> way{lanes::transpose_times(first.R, last.R),
                                  lanes::transpose_times(first.R, motion::difference(last.x, first.x))};
  const Vec6<double> d = Se3::log(way);
  const Vec6<double> begin = h * first.v, end = h * motion::inverse_tangent_times(d, last.v);
  const double s = part, rest = 1.0 - part;
  const Vec6<double> p = (s * s * (3.0 - 2.0 * s)) * d + (s * rest * rest) * begin - (s * s * rest) * end;
  const Vec6<double> rate = (6.0 * s * rest) * d + (rest * (1.0 - 3.0 * s)) * begin + (s * (3.0 * s - 2.0)) * end;
  const motion::Frame<double> step = Se3::exp(p);
  out.R = first.R * step.R;
  out.x = first.x;
  out.x.add(first.R * step.x);
  out.v = (1.0 / h) * motion::tangent_times(p, rate);
}

}  // namespace bough::step
