/// Makes the elements of a reduced model from those in space, by restricting their constants to the motions of its
/// group.
#include <algorithm>
#include <cmath>

#include "plan_builder.hpp"

namespace bough::plan {

using motion::Mat3;
using motion::Mat6;
using motion::Vec2;
using motion::Vec3;
using motion::Vec6;

namespace {

using elements::RowKind;

/// The leading components of a direction, those along which the nodes move.
template <class G>
typename G::template Translation<double> leading(const Vec3<double>& v) {
  typename G::template Translation<double> u;
  for (int i = 0; i < G::translations; ++i) u[i] = v[i];
  return u;
}

/// Restricts the data of an element in space to the components of the unknowns in axes B (of dead loads: `inertial`).
template <class G>
class Restriction {
  using Matrix = typename G::template Matrix<double>;
  using Vector = typename G::template Vector<double>;

 public:
  Restriction(const NodeUnknowns& unknowns, const Mat3<double>& B, const Mat3<double>& inertial)
      : kept_(unknowns.component), B_(B), inertial_(inertial) {}
  void number(double x, double& y) const { y = x; }
  /// [B^T 0; 0 B^T] M [B 0; 0 B], restricted to the rows and columns of the unknowns.
  void matrix(const Mat6<double>& m, Matrix& r) const {
    for (int i = 0; i < G::dof; ++i)
      for (int j = 0; j < G::dof; ++j) {
        const int a = kept(i), b = kept(j);
        double sum = 0.0;
        for (int k = 0; k < 3; ++k)
          for (int l = 0; l < 3; ++l) sum += B_(k, a % 3) * m(a / 3 * 3 + k, b / 3 * 3 + l) * B_(l, b % 3);
        r(i, j) = sum;
      }
  }
  void vector(const Vec6<double>& x, Vector& y) const { y = restricted(x, B_); }
  void unit(const Vec3<double>& x, typename G::template Translation<double>& y) const {
    y = leading<G>(lanes::transpose_times(B_, x));
  }
  void axis(const Vec3<double>& x, lanes::Vec<double, 1>& y) const {
    y[0] = lanes::transpose_times(B_, x)[2] > 0.0 ? 1.0 : -1.0;
  }
  void wrench(const Vec6<double>& x, Vector& y, bool follows) const { y = restricted(x, follows ? B_ : inertial_); }
  void flag(bool x, bool& y) const { y = x; }
  void law(int x, int& y) const { y = x; }

 private:
  int kept(int i) const { return kept_[static_cast<std::size_t>(i)]; }
  Vector restricted(const Vec6<double>& v, const Mat3<double>& B) const {
    const Vec3<double> parts[2] = {lanes::transpose_times(B, lanes::linear_part(v)),
                                   lanes::transpose_times(B, lanes::angular_part(v))};
    Vector r;
    for (int i = 0; i < G::dof; ++i) r[i] = parts[kept(i) / 3][kept(i) % 3];
    return r;
  }

  const std::array<int, 6>& kept_;
  const Mat3<double>&B_, &inertial_;
};

/// Whether the rows kept in the plane would also be satisfied after half a turn. A row for which the pose after half a
/// turn is an admissible pose of the joint, such as a row of one axis only, has no wrong branch.
bool has_branch(const elements::Joint& e, const std::vector<int>& rows) {
  const auto is_kept = [&rows](int row) { return std::find(rows.begin(), rows.end(), row) != rows.end(); };
  for (int k = 0; k < e.num_rows; ++k) {
    if (e.rows[k].kind != RowKind::across) continue;
    if (elements::aligns_all_axes(e, k)) return is_kept(k) || is_kept(k + 1) || is_kept(k + 2);
    if (e.rows[k].j == 2 && is_kept(k)) return true;
  }
  return false;
}

/// Restricts the elements of a scene to the group G.
template <class G>
class Reducer {
  using Translation = typename G::template Translation<double>;
  using ReducedPort = elements::PortOn<G, double>;
  using ReducedJoint = elements::JointOn<G>;

 public:
  explicit Reducer(const Builder& builder) : b_(builder), axes_(builder.plan.axes), origin_(builder.plan.origin) {}

  template <class R, class E>
  R reduced(const E& e) const {
    using elements::DataAxes;
    const Mat3<double> B = E::data_axes == DataAxes::section ? section_axes(e.ports[0]) : axes_at(e.ports[0]);
    R r;
    for (int k = 0; k < E::num_ports; ++k)
      r.ports[k] = port(e.ports[k], E::data_axes == DataAxes::none ? axes_at(e.ports[k]) : B);
    const Restriction<G> restriction(b_.plan.unknowns, B, axes_);
    E::visit_data(e, r, restriction);
    return r;
  }
  ReducedJoint reduced(const elements::Joint& e, const std::vector<int>& rows) const {
    const Mat3<double> Ba = joint_axes(e.ports[0]), Bb = joint_axes(e.ports[1]);
    const auto unit = [](const Mat3<double>& B, int i) { return leading<G>({{B(i, 0), B(i, 1), B(i, 2)}}); };
    Translation sign = Translation::zero();
    sign[0] = lanes::column(Ba, 2)[2] > 0.0 ? 1.0 : -1.0;
    ReducedJoint r;
    r.ports[0] = port(e.ports[0], Ba);
    r.ports[1] = port(e.ports[1], Bb);
    if constexpr (G::turns) {
      r.has_branch = has_branch(e, rows);
      const double along = lanes::column(axes_at(e.ports[0]), 2)[2];
      r.axis_sign = std::abs(along) > 0.5 ? (along > 0.0 ? 1 : -1) : 0;
    }
    for (int row : rows) {
      const elements::ConstraintRow& from = e.rows[row];
      elements::ConstraintRowOn<G, double>& to = r.rows[r.num_rows++];
      to.kind = from.kind;
      to.law = from.law;
      to.constant = from.constant;
      to.d = from.kind == RowKind::along ? unit(Ba, from.i) : sign;
      if constexpr (G::turns)
        if (from.kind == RowKind::across) {  // g . (c k + s i k)
          const Vec2<double> g = unit(Ba, from.i), k = unit(Bb, from.j);
          to.d = {{lanes::dot(g, k), lanes::dot(g, motion::quarter_turn(k))}};
        }
    }
    for (int k = 0; k < e.num_efforts; ++k) {
      const elements::Effort& from = e.efforts[k];
      const Translation d = from.coordinate == RowKind::angle ? sign : unit(Ba, 2);
      r.efforts[r.num_efforts++] = {from.coordinate, from.stiffness, from.rest, from.damping, from.law, {d}};
    }
    return r;
  }

  NodeStartOn<G> node(std::size_t n) const {
    const motion::Frame<double>& pose = b_.plan.nodes[n].pose;
    NodeStartOn<G> r;
    r.basis = basis_of(n);
    r.rotation = motion::normalise(motion::quaternion_of(pose.R));
    r.place = motion::PositionPair<double>::from(pose.x);
    Vec3<double> hi, lo;
    for (int i = 0; i < 3; ++i) motion::two_sum(pose.x[i], -origin_[i], hi[i], lo[i]);
    for (int i = 0; i < G::translations; ++i) {
      const Vec3<double> along = lanes::column(axes_, i);
      r.x.hi[i] = lanes::dot(along, hi);
      r.x.lo[i] = lanes::dot(along, lo);
    }
    if constexpr (G::turns) {
      const Vec3<double> first = motion::rotation_of(r.rotation) * lanes::column(r.basis, 0);
      for (int i = 0; i < 2; ++i) r.turn[i] = lanes::dot(lanes::column(axes_, i), first);
    }
    return r;
  }

 private:
  Mat3<double> basis_of(std::size_t node) const {
    const std::vector<Mat3<double>>& basis = b_.plan.unknowns.basis;
    return basis.empty() ? Mat3<double>::identity() : basis[node];
  }
  /// Axes of the model in those of a port's frame, with the first two rotated to the port's own.
  Mat3<double> axes_at(const elements::Port& p) const { return lanes::transpose_times(b_.initial_pose(p).R, axes_); }
  Mat3<double> with_first(const Vec3<double>& first, const Vec3<double>& normal) const {
    const Vec3<double> second = lanes::cross(normal, first);
    Mat3<double> B;
    for (int i = 0; i < 3; ++i) {
      B(i, 0) = first[i];
      B(i, 1) = second[i];
      B(i, 2) = normal[i];
    }
    return B;
  }
  Mat3<double> section_axes(const elements::Port& p) const {
    return with_first(Vec3<double>::unit(0), lanes::column(axes_at(p), 2));
  }
  /// In a plane with axis 3 as the normal, both frames of a joint keep their own axis 1, so that angles are those of
  /// the joint.
  Mat3<double> joint_axes(const elements::Port& p) const {
    const Mat3<double> B = axes_at(p);
    const Vec3<double> normal = lanes::column(B, 2);
    return G::turns && std::abs(normal[2]) > 0.5 ? with_first(Vec3<double>::unit(0), normal) : B;
  }
  /// A port with axes B (in the port's own), relative to its node's frame on the group.
  ReducedPort port(const elements::Port& p, const Mat3<double>& B) const {
    constexpr double round_off = 4e-16;
    ReducedPort r;
    r.node = p.node;
    const bool on_ground = p.node == elements::ground;
    const Mat3<double> own = on_ground ? axes_ : basis_of(static_cast<std::size_t>(p.node));
    typename G::template Pose<double>& at = r.offset;
    if (on_ground)
      at.x = leading<G>(lanes::transpose_times(own, Vec3<double>(p.offset.x - origin_)));
    else if (p.has_offset)
      at.x = leading<G>(lanes::transpose_times(own, p.offset.x));
    for (int i = 0; i < G::translations; ++i) r.has_offset |= at.x[i] != 0.0;
    if constexpr (G::turns) {
      const Mat3<double> turned = (on_ground || p.has_offset ? p.offset.R : Mat3<double>::identity()) * B;
      const Mat3<double> Q = lanes::transpose_times(own, turned);
      at.R = {{Q(0, 0), Q(1, 0)}};
      // Axes that are in the plane within the precision of the scene alone are not of unit length there.
      if (b_.plan.precision > 0.0) at.R = (1.0 / lanes::length_of(at.R)) * at.R;
      if (std::abs(at.R[1]) <= round_off && at.R[0] > 0.0) at.R = {{1.0, 0.0}};
      r.has_offset |= at.R[1] != 0.0 || at.R[0] != 1.0;
    }
    return r;
  }

  const Builder& b_;
  const Mat3<double>& axes_;
  const Vec3<double>& origin_;
};

template <class G>
void add_model(Builder& b) {
  Plan& plan = b.plan;
  ModelOn<G> model;
  const Reducer<G> reducer(b);
  std::vector<const JointPlan*> joint_of(plan.joints.size());
  for (const JointPlan& j : plan.joints)
    joint_of.at(static_cast<std::size_t>(plan.directory[static_cast<std::size_t>(j.element)].index)) = &j;
  const auto fill = [&]<std::size_t... I>(std::index_sequence<I...>) {
    const auto one = [&]<class E, class R>(const std::vector<E>& from, std::vector<R>& to) {
      if constexpr (!std::is_same_v<R, NoElement>) {
        to.reserve(from.size());
        for (std::size_t i = 0; i < from.size(); ++i) {
          if constexpr (E::role == elements::Role::joint)
            to.push_back(reducer.reduced(from[i], joint_of[i]->rows));
          else
            to.push_back(reducer.template reduced<R>(from[i]));
        }
      }
    };
    (one(std::get<I>(plan.elements), std::get<I>(model.elements)), ...);
  };
  fill(std::make_index_sequence<std::tuple_size_v<ElementArrays>>{});
  for (const SignalPlan& s : driving_signals(plan)) model.readings.push_back(reducer.reduced(s.reading, {}));
  model.nodes.reserve(plan.nodes.size());
  for (std::size_t n = 0; n < plan.nodes.size(); ++n) model.nodes.push_back(reducer.node(n));
  plan.model = std::move(model);
}

}  // namespace

void Builder::add_reduced_model(const Mat3<double>& axes) {
  plan.axes = axes;
  plan.origin = plan.nodes.front().pose.x;
  switch (plan.unknowns.motions) {
    case Motions::planar:
      return add_model<motion::Se2>(*this);
    case Motions::translation:
      return add_model<motion::Translations<3>>(*this);
    case Motions::line:
      return add_model<motion::Translations<1>>(*this);
    case Motions::spatial:
      break;
  }
}

}  // namespace bough::plan
