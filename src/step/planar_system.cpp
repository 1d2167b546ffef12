#include "planar_system.hpp"

namespace bough::step {

using motion::Mat3;
using motion::Vec3;
using motion::Vec6;

void PlanarSystem::set_nodes(const State& state, std::int64_t begin, std::int64_t end) {
  const plan::NodeUnknowns& u = plan_.unknowns;
  const Mat3<double>& axes = plan_.planar->axes;
  const Vec3<double>& origin = plan_.planar->origin;
  const auto flat = [](const Mat3<double>& B, const Vec6<double>& v) {
    const auto along = [&B](int column, const double* x) {
      return B(0, column) * x[0] + (B(1, column) * x[1] + B(2, column) * x[2]);
    };
    return Vec3<double>{{along(0, v.v), along(1, v.v), along(2, v.v + 3)}};
  };
  const auto own = [](const Vec6<double>& v) { return Vec3<double>{{v[0], v[1], v[5]}}; };
  for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n) {
    const elements::NodeMotion& from = state.nodes[n];
    elements::NodeMotionOn<motion::Se2, double>& to = nodes_[n];
    Vec3<double> first = lanes::column(from.R, 0);  // of the planar frame
    if (u.basis.empty()) {
      to.v = own(from.v);
      to.a = own(from.a);
      to.dq = own(from.dq);
    } else {
      const Mat3<double>& B = u.basis[n];
      first = from.R * lanes::column(B, 0);
      to.v = flat(B, from.v);
      to.a = flat(B, from.a);
      to.dq = flat(B, from.dq);
    }
    Vec3<double> hi, lo;
    for (int i = 0; i < 3; ++i) {
      motion::two_sum(from.x.hi[i], -origin[i], hi[i], lo[i]);
      lo[i] += from.x.lo[i];
    }
    for (int i = 0; i < 2; ++i) {
      const Vec3<double> axis = lanes::column(axes, i);
      to.R[i] = lanes::dot(axis, first);
      to.x.hi[i] = lanes::dot(axis, hi);
      to.x.lo[i] = lanes::dot(axis, lo);
    }
  }
}

void PlanarSystem::set_field(const elements::Field& field) {
  const Vec3<double> gravity = lanes::transpose_times(plan_.planar->axes, field.around.gravity);
  field_.around.gravity = motion::plane_part(gravity);
  field_.around.laws = field.around.laws;
  field_.around.has_inertia = field.around.has_inertia;
  field_.slopes = field.slopes;
}

PlanarSystem::Counts PlanarSystem::evaluate_alone(std::size_t id, const State& state, double* residual,
                                                  double* magnitude, double* tangent) const {
  std::array<double, elements::max_rows> multipliers;
  const int j = joint_of_element_[id];
  double turns = 0.0;
  if (j >= 0) {
    const plan::JointPlan& joint = plan_.joints[static_cast<std::size_t>(j)];
    for (std::size_t r = 0; r < joint.rows.size(); ++r)
      multipliers[r] = state.multipliers[static_cast<std::size_t>(joint.multiplier_begin + joint.rows[r])];
    turns = state.turns[static_cast<std::size_t>(j)];
  }
  Counts counts{};
  plan::with_element(plan_.planar->elements, plan_.directory[id], [&](const auto& e) {
    elements::evaluate(e, field_, multipliers.data(), turns, residual, tangent);
    elements::eval_magnitude(e, field_, residual, magnitude);
    counts = {num_unknowns(e), num_multipliers(e)};
  });
  return counts;
}

void PlanarSystem::place_alone(std::size_t id, const State& state, const ElementResults& to) const {
  const auto element = static_cast<int>(id);
  const solve::ElementView view = to.want_tangents() ? to.tangent_of(element) : solve::ElementView{};
  const bool is_direct = view.stride == 1 && !(held_ != nullptr && held_->trims(id));
  std::array<double, most_unknowns * most_unknowns> entries;
  std::array<double, most_unknowns> residual, magnitude;
  const Counts counts = evaluate_alone(id, state, residual.data(), magnitude.data(),
                                       !to.want_tangents() ? nullptr
                                       : is_direct         ? view.first
                                                           : entries.data());
  join_parts(3, counts.unknowns, counts.rows, residual.data(), magnitude.data(), to.parts_of(element));
  if (!to.want_tangents() || is_direct) return;
  write_matrix(
      held_, id, counts.unknowns, [&](int i) { return entries[static_cast<std::size_t>(i)]; }, view);
}

}  // namespace bough::step
