/// Makes the elements of a scene that moves in a plane from those in space, by restricting their constants to the
/// plane.
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
using PlanarPort = elements::PortOn<motion::Se2, double>;
using PlanarJoint = elements::JointOn<motion::Se2>;

constexpr int kept[3] = {0, 1, 5};

/// [B^T 0; 0 B^T] M [B 0; 0 B], restricted to rows and columns of the plane.
Mat3<double> in_plane(const Mat6<double>& m, const Mat3<double>& B) {
  Mat3<double> r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int a = kept[i], b = kept[j];
      double sum = 0.0;
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l) sum += B(k, a % 3) * m(a / 3 * 3 + k, b / 3 * 3 + l) * B(l, b % 3);
      r(i, j) = sum;
    }
  return r;
}
Vec3<double> in_plane(const Vec6<double>& v, const Mat3<double>& B) {
  const Vec3<double> linear = lanes::transpose_times(B, lanes::linear_part(v)),
                     angular = lanes::transpose_times(B, lanes::angular_part(v));
  return {{linear[0], linear[1], angular[2]}};
}
Vec2<double> in_plane(const Vec3<double>& v, const Mat3<double>& B) {
  return motion::plane_part(lanes::transpose_times(B, v));
}

/// Restricts the data of an element in space to the plane with axes B (of dead loads: `inertial`).
class Restriction {
 public:
  Restriction(const Mat3<double>& B, const Mat3<double>& inertial) : B_(B), inertial_(inertial) {}
  void number(double x, double& y) const { y = x; }
  void matrix(const Mat6<double>& x, Mat3<double>& y) const { y = in_plane(x, B_); }
  void vector(const Vec6<double>& x, Vec3<double>& y) const { y = in_plane(x, B_); }
  void wrench(const Vec6<double>& x, Vec3<double>& y, bool follows) const { y = in_plane(x, follows ? B_ : inertial_); }
  void flag(bool x, bool& y) const { y = x; }
  void law(int x, int& y) const { y = x; }

 private:
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

class Flattener {
 public:
  Flattener(const Builder& builder, const PlanarModel& model) : b_(builder), model_(model) {}

  template <class R, class E>
  R flattened(const E& e) const {
    using elements::DataAxes;
    const Mat3<double> B = E::data_axes == DataAxes::section ? section_axes(e.ports[0]) : axes_at(e.ports[0]);
    R r;
    for (int k = 0; k < E::num_ports; ++k)
      r.ports[k] = port(e.ports[k], E::data_axes == DataAxes::none ? axes_at(e.ports[k]) : B);
    const Restriction restriction(B, model_.axes);
    E::visit_data(e, r, restriction);
    return r;
  }
  /// If axis 3 is the normal, both frames keep their own axis 1, so that angles are those of the joint.
  PlanarJoint flattened(const elements::Joint& e, const std::vector<int>& rows) const {
    const Mat3<double> Ba = joint_axes(e.ports[0]), Bb = joint_axes(e.ports[1]);
    const Vec3<double> normal_a = lanes::column(Ba, 2);
    const auto unit = [](const Mat3<double>& B, int i) { return Vec2<double>{{B(i, 0), B(i, 1)}}; };
    const Vec2<double> sign{{normal_a[2] > 0.0 ? 1.0 : -1.0, 0.0}};
    PlanarJoint r;
    r.ports[0] = port(e.ports[0], Ba);
    r.ports[1] = port(e.ports[1], Bb);
    r.has_branch = has_branch(e, rows);
    const double along = lanes::column(axes_at(e.ports[0]), 2)[2];
    r.axis_sign = std::abs(along) > 0.5 ? (along > 0.0 ? 1 : -1) : 0;
    for (int row : rows) {
      const elements::ConstraintRow& from = e.rows[row];
      elements::ConstraintRowOn<motion::Se2, double>& to = r.rows[r.num_rows++];
      to.kind = from.kind;
      to.law = from.law;
      if (from.kind == RowKind::along) {
        to.d = unit(Ba, from.i);
      } else if (from.kind == RowKind::across) {  // g . (c k + s i k)
        const Vec2<double> g = unit(Ba, from.i), k = unit(Bb, from.j);
        to.d = {{lanes::dot(g, k), lanes::dot(g, motion::quarter_turn(k))}};
      } else {
        to.d = sign;
      }
    }
    for (int k = 0; k < e.num_efforts; ++k) {
      const elements::Effort& from = e.efforts[k];
      const Vec2<double> d = from.coordinate == elements::Coordinate::angle ? sign : unit(Ba, 2);
      r.efforts[r.num_efforts++] = {from.coordinate, from.stiffness, from.rest, from.damping, from.law, {d}};
    }
    return r;
  }

  PlanarNode node(std::size_t n) const {
    const motion::Frame<double>& pose = b_.plan.nodes[n].pose;
    const NodeUnknowns& u = b_.plan.unknowns;
    PlanarNode r;
    r.basis = u.basis.empty() ? Mat3<double>::identity() : u.basis[n];
    r.rotation = motion::normalise(motion::quaternion_of(pose.R));
    r.place = motion::PositionPair<double>::from(pose.x);
    const Vec3<double> first = motion::rotation_of(r.rotation) * lanes::column(r.basis, 0);
    Vec3<double> hi, lo;
    for (int i = 0; i < 3; ++i) motion::two_sum(pose.x[i], -model_.origin[i], hi[i], lo[i]);
    for (int i = 0; i < 2; ++i) {
      const Vec3<double> along = lanes::column(model_.axes, i);
      r.turn[i] = lanes::dot(along, first);
      r.x.hi[i] = lanes::dot(along, hi);
      r.x.lo[i] = lanes::dot(along, lo);
    }
    return r;
  }

 private:
  /// Axes of the plane in those of a port's frame, with the first two rotated to the port's own.
  Mat3<double> axes_at(const elements::Port& p) const {
    return lanes::transpose_times(b_.initial_pose(p).R, model_.axes);
  }
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
  Mat3<double> joint_axes(const elements::Port& p) const {
    const Mat3<double> B = axes_at(p);
    const Vec3<double> normal = lanes::column(B, 2);
    return std::abs(normal[2]) > 0.5 ? with_first(Vec3<double>::unit(0), normal) : B;
  }
  /// A port with axes B (in the port's own), relative to its node's planar frame.
  PlanarPort port(const elements::Port& p, const Mat3<double>& B) const {
    constexpr double round_off = 4e-16;
    PlanarPort r;
    r.node = p.node;
    const bool on_ground = p.node == elements::ground;
    const Mat3<double> turned = (on_ground || p.has_offset ? p.offset.R : Mat3<double>::identity()) * B;
    const Mat3<double> own = on_ground ? model_.axes
                             : b_.plan.unknowns.basis.empty()
                                 ? Mat3<double>::identity()
                                 : b_.plan.unknowns.basis[static_cast<std::size_t>(p.node)];
    const Mat3<double> Q = lanes::transpose_times(own, turned);
    motion::PlanePose<double>& at = r.offset;
    at.R = {{Q(0, 0), Q(1, 0)}};
    if (on_ground)
      at.x = in_plane(Vec3<double>(p.offset.x - model_.origin), own);
    else if (p.has_offset)
      at.x = in_plane(p.offset.x, own);
    if (std::abs(at.R[1]) <= round_off && at.R[0] > 0.0) at.R = {{1.0, 0.0}};
    r.has_offset = at.R[1] != 0.0 || at.R[0] != 1.0 || at.x[0] != 0.0 || at.x[1] != 0.0;
    return r;
  }

  const Builder& b_;
  const PlanarModel& model_;
};

}  // namespace

void Builder::add_planar_elements(const Mat3<double>& axes) {
  PlanarModel& model = plan.planar.emplace();
  model.axes = axes;
  model.origin = plan.nodes.front().pose.x;
  const Flattener flatten(*this, model);
  std::map<int, const JointPlan*> joint_of;
  for (const JointPlan& j : plan.joints) joint_of[plan.directory[static_cast<std::size_t>(j.element)].index] = &j;
  const auto fill = [&]<std::size_t... I>(std::index_sequence<I...>) {
    const auto one = [&](const auto& from, auto& to) {
      for (std::size_t i = 0; i < from.size(); ++i) {
        if constexpr (std::decay_t<decltype(from[i])>::role == elements::Role::joint)
          to.push_back(flatten.flattened(from[i], joint_of.at(static_cast<int>(i))->rows));
        else
          to.push_back(flatten.flattened<std::decay_t<decltype(to[0])>>(from[i]));
      }
    };
    (one(std::get<I>(plan.elements), std::get<I>(model.elements)), ...);
  };
  fill(std::make_index_sequence<std::tuple_size_v<ElementArrays>>{});
  for (std::size_t n = 0; n < plan.nodes.size(); ++n) model.nodes.push_back(flatten.node(n));
}

}  // namespace bough::plan
