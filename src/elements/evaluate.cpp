#include "bough/elements/evaluate.hpp"

#include "evaluate_impl.hpp"

namespace bough::elements {

Mat6<double> make_mass_matrix(double mass, const Vec3<double>& center, const Mat3<double>& inertia) {
  const Mat3<double> c = lanes::skew(center);
  const Mat3<double> about_origin = inertia - mass * (c * c);  // Huygens and Steiner
  Mat6<double> M = Mat6<double>::zero();
  for (int i = 0; i < 3; ++i) {
    M(i, i) = mass;
    for (int j = 0; j < 3; ++j) {
      M(i, 3 + j) = -mass * c(i, j);
      M(3 + i, j) = mass * c(i, j);
      M(3 + i, 3 + j) = about_origin(i, j);
    }
  }
  return M;
}

namespace {

template <int K>
void eval_rows(const Joint& joint, const Field& field, const Vec6<double>* jerk, const lanes::Taylor<double, K>* laws,
               double turns, lanes::Taylor<double, K>* out) {
  using T = lanes::Taylor<double, K>;
  const motion::Vec3Pair anchor = anchor_of(joint, field.nodes);
  PortMotion<T> p[2];
  for (int k = 0; k < 2; ++k) {
    const Port& port = joint.ports[k];
    Vec6<double> j = Vec6<double>::zero();
    if (port.node != ground && jerk != nullptr)
      j = port.has_offset ? motion::inverse_adjoint_times(port.offset, jerk[port.node]) : jerk[port.node];
    if (port.node == ground && port.carrier >= 0)
      j = motion::inverse_adjoint_times(port.offset, field.carriers[port.carrier].twist_second);
    p[k] = series_of<K>(eval_port(port, field.nodes, anchor, field.carriers), j);
  }
  const Frame<T> H = motion::relative(p[0].H, p[1].H);
  Vec6<T> gradient;
  for (int k = 0; k < joint.num_rows; ++k) out[k] = eval_row(joint.rows[k], H, turns, laws, gradient);
}

}  // namespace

void evaluate_constraint_series(const Joint& joint, const Field& field, const Vec6<double>* jerk,
                                const lanes::Taylor<double, 3>* laws, double turns, lanes::Taylor<double, 3>* out) {
  eval_rows<3>(joint, field, jerk, laws, turns, out);
}

void evaluate_constraint_rates(const Joint& joint, const Field& field, const lanes::Taylor<double, 1>* laws,
                               double turns, lanes::Taylor<double, 1>* out) {
  eval_rows<1>(joint, field, nullptr, laws, turns, out);
}

CoordinateMotion eval_joint_coordinate(const Joint& joint, RowKind coordinate, const Field& field, double turns) {
  const motion::Vec3Pair anchor = anchor_of(joint, field.nodes);
  const PortMotion<double> a = eval_port(joint.ports[0], field.nodes, anchor, field.carriers);
  const PortMotion<double> b = eval_port(joint.ports[1], field.nodes, anchor, field.carriers);
  const Frame<double> H = motion::relative(a.H, b.H);
  motion::DualVec<double> gradient;
  const double value = eval_coordinate<motion::Se3, double, double>(coordinate, motion::Se3::Direction<double>::axial(),
                                                                    0.0, H, turns, gradient);
  return {value, lanes::dot(motion::wrench_vector(gradient), b.v - motion::inverse_adjoint_times(H, a.v))};
}

BOUGH_EMIT(alone_drivers, _of_points, std::tuple<RigidBody, PointLoad>)

}  // namespace bough::elements
