/// Finds the invariant set of motions of a scene, which determines the unknowns of its nodes.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "geometry.hpp"
#include "plan_builder.hpp"

namespace bough::plan {

using elements::Port;
using elements::RowKind;
using motion::Frame;
using motion::Mat3;
using motion::Mat6;
using motion::Vec3;
using motion::Vec6;

namespace {

using Obstacle = std::optional<std::string>;  ///< reason against a set of motions, in words

constexpr double small = 1e-12;  ///< relative difference of computed directions and positions by round-off

Vec3<double> linear(const Vec6<double>& v) { return lanes::linear_part(v); }
Vec3<double> angular(const Vec6<double>& v) { return lanes::angular_part(v); }

/// Three axes, `which` of them along `direction`.
Mat3<double> axes_with(int which, const Vec3<double>& direction) {
  int least = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(direction[i]) < std::abs(direction[least]) - small) least = i;
  Vec3<double> second = lanes::cross(direction, Vec3<double>::unit(least));
  second = (1.0 / length_of(second)) * second;
  const Vec3<double> third = lanes::cross(direction, second);
  Mat3<double> axes;
  for (int i = 0; i < 3; ++i) {
    axes(i, which) = direction[i];
    axes(i, (which + 1) % 3) = second[i];
    axes(i, (which + 2) % 3) = third[i];
  }
  return axes;
}

/// How strongly a matrix of a section or body couples motions in the plane with those out of it, relative to its
/// diagonal entries; columns of axes: two along the plane, then the normal.
double coupling_of(const Mat6<double>& m, const Mat3<double>& axes) {
  double turned[6][6], largest[2] = {0.0, 0.0};
  for (int p : {0, 3})
    for (int q : {0, 3}) {
      Mat3<double> block;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) block(i, j) = m(p + i, q + j);
      const Mat3<double> result = lanes::transpose_times(axes, block * axes);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) turned[p + i][q + j] = result(i, j);
    }
  for (int i = 0; i < 6; ++i) largest[i / 3] = std::max(largest[i / 3], std::abs(turned[i][i]));
  constexpr int inside[3] = {0, 1, 5}, outside[3] = {2, 3, 4};
  double strongest = 0.0;
  for (int i : inside)
    for (int j : outside) {
      const double entry = std::max(std::abs(turned[i][j]), std::abs(turned[j][i]));
      if (entry > 0.0) strongest = std::max(strongest, entry / std::sqrt(largest[i / 3] * largest[j / 3]));
    }
  return strongest;
}

/// Where a coupling acts, its directions and axes in the ground, and its matrices in the axes of the first port.
struct CouplingSets {
  const Port (&ports)[2];
  std::vector<Vec3<double>> directions, axes;
  std::vector<const Mat6<double>*> matrices;
};

/// A set of motions, and the condition for elements to keep it: `against` returns the first reason against it.
class Motion {
 public:
  Motion(const Builder& builder, double tolerance)
      : b_(builder), size_(builder.plan.length_scale), tolerance_(tolerance) {}
  virtual ~Motion() = default;

  /// Largest relative difference from the set that was met and tolerated.
  double largest_difference() const { return largest_difference_; }

  virtual Motions kind() const = 0;
  virtual std::array<int, 6> components() const = 0;
  virtual int count() const = 0;
  virtual Mat3<double> axes() const = 0;  ///< columns of B, in the ground

  virtual Obstacle against(const elements::RigidBody& e) = 0;
  virtual Obstacle against(const elements::Joint& e) = 0;
  virtual Obstacle against(const elements::PointLoad& e) = 0;
  template <int N>
  Obstacle against(const elements::Beam<N>& e) {
    Frame<double> pose[N];
    for (int i = 0; i < N; ++i) pose[i] = b_.initial_pose(e.ports[i]);
    return against_beam(pose, N, {&e.stiffness, &e.mass, &e.damping}, e.reference_strain, e.num_strain_points,
                        e.length);
  }
  template <int N>
  Obstacle against(const elements::LineLoad<N>& e) {
    return against_wrench(e.wrench, e.follows ? b_.initial_pose(e.ports[0]).R : Mat3<double>::identity());
  }
  /// A coupling of the catalogue keeps a set that has its places and directions.
  template <elements::IsCatalogued E>
  Obstacle against(const E& e) {
    const Mat3<double> axes = b_.initial_pose(e.ports[0]).R;
    CouplingSets sets{e.ports, {}, {}, {}};
    const auto look = [&](const auto& datum) {
      constexpr scene::CouplingFieldType type = std::decay_t<decltype(datum)>::type;
      if constexpr (type == scene::CouplingFieldType::direction) sets.directions.push_back(axes * (e.*datum.member));
      if constexpr (type == scene::CouplingFieldType::axis) sets.axes.push_back(axes * (e.*datum.member));
      if constexpr (type == scene::CouplingFieldType::matrix) sets.matrices.push_back(&(e.*datum.member));
    };
    std::apply([&](const auto&... data) { (look(data), ...); }, E::declared());
    return against_coupling(sets);
  }
  virtual Obstacle against_gravity() = 0;
  virtual Obstacle against_node(const NodePlan& node) = 0;

  /// Whether a row of a joint is an unknown. Precondition: there is no reason against the joint.
  virtual bool keeps(const elements::Joint& e, int row) = 0;

 protected:
  virtual Obstacle against_beam(const Frame<double>* pose, int count, std::array<const Mat6<double>*, 3> section,
                                const Vec6<double>* strain, int points, double length) = 0;
  virtual Obstacle against_wrench(const Vec6<double>& wrench, const Mat3<double>& axes) = 0;
  virtual Obstacle against_coupling(const CouplingSets& coupling) = 0;

  /// Whether a difference from the set is more than the tolerance; notes it otherwise.
  bool exceeds(double difference, double scale = 1.0) {
    if (!(difference <= tolerance_ * scale)) return true;
    if (difference > 0.0) largest_difference_ = std::max(largest_difference_, difference / scale);
    return false;
  }

  const Builder& b_;
  double size_;       ///< of the structure [m]
  double tolerance_;  ///< relative
  double largest_difference_ = 0.0;
};

/// Mirror symmetry about a plane: geometry, masses and loads are their own mirror images, so all forces out of the
/// plane vanish.
class InPlane final : public Motion {
 public:
  InPlane(const Builder& builder, const Vec3<double>& normal, double tolerance)
      : Motion(builder, tolerance), normal_(normal), height_(lanes::dot(normal, builder.plan.nodes.front().pose.x)) {}

  Motions kind() const override { return Motions::planar; }
  std::array<int, 6> components() const override { return {0, 1, 5, 2, 3, 4}; }
  int count() const override { return 3; }
  Mat3<double> axes() const override { return axes_with(2, normal_); }

  Obstacle against(const elements::RigidBody& e) override {
    const Frame<double> pose = b_.initial_pose(e.ports[0]);
    return exceeds(coupling_of(e.mass, axes_with(2, normal_in(pose))))
               ? Obstacle{"its mass is not symmetric about the plane (centre of mass, principal axes)"}
               : std::nullopt;
  }
  Obstacle against(const elements::PointLoad& e) override {
    if (auto o = against_places(e.ports)) return o;
    return against_wrench(e.wrench, e.follows ? b_.initial_pose(e.ports[0]).R : Mat3<double>::identity());
  }
  Obstacle against(const elements::Joint& e) override {
    if (auto o = against_places(e.ports)) return o;
    const Vec3<double> a = normal_in(b_.initial_pose(e.ports[0])), b = normal_in(b_.initial_pose(e.ports[1]));
    for (int k = 0; k < e.num_rows; ++k) {
      const elements::ConstraintRow& row = e.rows[k];
      const bool upright = along(a, 2) && along(b, 2) && a[2] * b[2] > 0.0;
      if (row.kind == RowKind::screw) return "it is a screw";
      if (row.kind == RowKind::angle && !upright) return "it holds or drives a rotation out of the plane";
      if (row.kind == RowKind::along && !along(a, row.i) && !beside(a, row.i)) return oblique();
      if (row.kind == RowKind::along && along(a, row.i) && row.law >= 0) return "it drives a motion out of the plane";
      if (row.kind != RowKind::across) continue;
      const bool first = along(a, row.i), second = along(b, row.j);
      if ((!first && !beside(a, row.i)) || (!second && !beside(b, row.j))) return oblique();
      if (first && second) return "it turns an axis out of the plane";
    }
    for (int k = 0; k < e.num_efforts; ++k) {
      if (motion::traits_of(e.efforts[k].coordinate).is_between_points) continue;
      const bool turns = e.efforts[k].coordinate == RowKind::angle;
      if (turns ? !along(a, 2) || !along(b, 2) : !beside(a, 2))
        return "a force or moment along its free motion acts out of the plane";
    }
    return std::nullopt;
  }
  bool keeps(const elements::Joint& e, int k) override {
    const elements::ConstraintRow& row = e.rows[k];
    const Vec3<double> a = normal_in(b_.initial_pose(e.ports[0])), b = normal_in(b_.initial_pose(e.ports[1]));
    if (row.kind == RowKind::along) return beside(a, row.i);
    if (row.kind == RowKind::across) return beside(a, row.i) && beside(b, row.j);
    return true;
  }
  Obstacle against_gravity() override {
    return exceeds(std::abs(lanes::dot(b_.plan.gravity, normal_)), length_of(b_.plan.gravity))
               ? Obstacle{"gravity acts out of the plane"}
               : std::nullopt;
  }
  Obstacle against_node(const NodePlan& node) override {
    if (is_outside(node.pose.x)) return "it lies outside the plane";
    const Vec3<double> v = node.pose.R * linear(node.twist), w = node.pose.R * angular(node.twist);
    if (exceeds(std::abs(lanes::dot(v, normal_)), length_of(v))) return "it starts out of the plane";
    if (exceeds(length_of(lanes::cross(w, normal_)), length_of(w))) return "it starts turning out of the plane";
    return std::nullopt;
  }

 private:
  Vec3<double> normal_in(const Frame<double>& pose) const { return lanes::transpose_times(pose.R, normal_); }
  bool along(const Vec3<double>& normal, int axis) {
    return !exceeds(std::hypot(normal[(axis + 1) % 3], normal[(axis + 2) % 3]));
  }
  bool beside(const Vec3<double>& normal, int axis) { return !exceeds(std::abs(normal[axis])); }
  static Obstacle oblique() { return "its axes are oblique to the plane"; }
  bool is_outside(const Vec3<double>& x) { return exceeds(std::abs(lanes::dot(x, normal_) - height_), size_); }
  template <std::size_t N>
  Obstacle against_places(const Port (&ports)[N]) {
    for (const Port& p : ports)
      if (is_outside(b_.initial_pose(p).x)) return "it takes hold outside the plane";
    return std::nullopt;
  }
  Obstacle against_beam(const Frame<double>* pose, int count, std::array<const Mat6<double>*, 3> section,
                        const Vec6<double>* strain, int points, double length) override {
    const Vec3<double> n = normal_in(pose[0]);
    if (exceeds(std::abs(n[0]))) return "its axis leaves the plane";
    for (int i = 0; i < count; ++i) {
      if (is_outside(pose[i].x)) return "it lies outside the plane";
      if (exceeds(length_of(normal_in(pose[i]) - n))) return "it is twisted";
    }
    const Mat3<double> axes = axes_with(2, n);
    for (std::size_t k = 0; k < section.size(); ++k) {
      if (is_same(*section[k], known_section_[k]) && is_same(axes, known_axes_[k])) continue;
      if (exceeds(coupling_of(*section[k], axes))) return "its section couples bending in the plane with other strains";
      known_section_[k] = *section[k];
      known_axes_[k] = axes;
    }
    for (int g = 0; g < points; ++g) {
      const Vec3<double> kappa = angular(strain[g]);
      if (exceeds(std::abs(lanes::dot(linear(strain[g]), n))) ||
          exceeds(length * length_of(lanes::cross(kappa, n)), std::max(1.0, length * length_of(kappa))))
        return "it is bent out of the plane";
    }
    return std::nullopt;
  }
  Obstacle against_wrench(const Vec6<double>& wrench, const Mat3<double>& axes) override {
    const Vec3<double> force = axes * linear(wrench), moment = axes * angular(wrench);
    if (exceeds(std::abs(lanes::dot(force, normal_)), length_of(force))) return "its force acts out of the plane";
    if (exceeds(length_of(lanes::cross(moment, normal_)), length_of(moment))) return "its moment acts out of the plane";
    return std::nullopt;
  }
  Obstacle against_coupling(const CouplingSets& coupling) override {
    for (const Vec3<double>& d : coupling.directions)
      if (exceeds(std::abs(lanes::dot(d, normal_)))) return "it acts out of the plane";
    for (const Vec3<double>& a : coupling.axes)
      if (exceeds(length_of(lanes::cross(a, normal_)))) return "it turns parts out of the plane";
    if (auto o = against_places(coupling.ports)) return o;
    if (coupling.matrices.empty()) return std::nullopt;
    const Mat3<double> axes = axes_with(2, normal_in(b_.initial_pose(coupling.ports[0])));
    for (const Mat6<double>* m : coupling.matrices)
      if (exceeds(coupling_of(*m, axes))) return "its stiffness or damping couples motions in the plane with others";
    return std::nullopt;
  }

  template <int R, int C>
  static bool is_same(const lanes::Mat<double, R, C>& a, const lanes::Mat<double, R, C>& b) {
    return std::equal(std::begin(a.m), std::end(a.m), std::begin(b.m));
  }

  Vec3<double> normal_;
  double height_;
  /// The last section, of stiffness, mass and damping, that couples nothing, and its axes: most beams have it, too.
  std::array<Mat6<double>, 3> known_section_{Mat6<double>::zero(), Mat6<double>::zero(), Mat6<double>::zero()};
  std::array<Mat3<double>, 3> known_axes_{Mat3<double>::zero(), Mat3<double>::zero(), Mat3<double>::zero()};
};

/// All forces act at the origins of nodes, so that nothing rotates; optionally also along one line only.
class OfPoints final : public Motion {
 public:
  OfPoints(const Builder& builder, std::optional<Vec3<double>> line, double tolerance)
      : Motion(builder, tolerance), line_(line) {}

  Motions kind() const override { return line_ ? Motions::line : Motions::translation; }
  std::array<int, 6> components() const override { return {0, 1, 2, 3, 4, 5}; }
  int count() const override { return line_ ? 1 : 3; }
  Mat3<double> axes() const override { return line_ ? axes_with(0, *line_) : Mat3<double>::identity(); }

  Obstacle against(const elements::RigidBody& e) override {
    const double mass = std::abs(e.mass(0, 0));
    for (int i = 0; i < 3; ++i)
      for (int j = 3; j < 6; ++j)
        if (exceeds(std::abs(e.mass(i, j)), mass * size_)) return "its centre of mass is not at its frame's origin";
    return std::nullopt;
  }
  Obstacle against(const elements::PointLoad& e) override {
    if (auto o = against_places(e.ports)) return o;
    if (e.follows) return "it follows rotations";
    return against_wrench(e.wrench, Mat3<double>::identity());
  }
  Obstacle against(const elements::Joint& e) override {
    if (e.num_efforts > 0) return "forces act along its free motion";
    if (e.ports[0].node != elements::ground) return "it joins two bodies";
    const Mat3<double>& axes = b_.initial_pose(e.ports[0]).R;
    for (int k = 0; k < e.num_rows; ++k) {
      const elements::ConstraintRow& row = e.rows[k];
      const bool is_between_points = motion::traits_of(row.kind).is_between_points;
      if (row.kind == RowKind::across) continue;
      if (row.kind != RowKind::along && !is_between_points) return "it turns";
      if (auto o = against_places(e.ports)) return o;
      if (!line_ || is_between_points) continue;
      const Vec3<double> axis = axis_of(axes, row.i);
      const bool is_across = !exceeds(std::abs(lanes::dot(*line_, axis)));
      if (!is_across && exceeds(length_of(lanes::cross(*line_, axis)))) return "its axes are oblique to the line";
      if (is_across && row.law >= 0) return "it drives a motion off the line";
    }
    return std::nullopt;
  }
  bool keeps(const elements::Joint& e, int k) override {
    if (motion::traits_of(e.rows[k].kind).is_between_points) return true;
    if (e.rows[k].kind != RowKind::along) return false;
    return !line_ || std::abs(lanes::dot(*line_, axis_of(b_.initial_pose(e.ports[0]).R, e.rows[k].i))) > 0.5;
  }
  Obstacle against_gravity() override {
    return is_off(b_.plan.gravity) ? Obstacle{"gravity acts off the line"} : std::nullopt;
  }
  Obstacle against_node(const NodePlan& node) override {
    if (length_of(angular(node.twist)) > 0.0) return "it starts turning";
    if (line_ && is_off(node.pose.x - b_.plan.nodes.front().pose.x, size_)) return "it lies off the line";
    return is_off(node.pose.R * linear(node.twist)) ? Obstacle{"it starts off the line"} : std::nullopt;
  }

 private:
  static Vec3<double> axis_of(const Mat3<double>& axes, int i) { return {{axes(0, i), axes(1, i), axes(2, i)}}; }
  bool is_off(const Vec3<double>& v, double scale = 0.0) {
    return line_ && exceeds(length_of(lanes::cross(v, *line_)), std::max(scale, length_of(v)));
  }
  template <std::size_t N>
  Obstacle against_places(const Port (&ports)[N]) {
    for (const Port& p : ports) {
      if (p.node != elements::ground && p.has_offset && exceeds(length_of(p.offset.x), size_))
        return "it takes hold beside the origin of a body's frame";
      if (is_off(b_.initial_pose(p).x - b_.plan.nodes.front().pose.x, size_)) return "it takes hold off the line";
    }
    return std::nullopt;
  }
  Obstacle against_beam(const Frame<double>*, int, std::array<const Mat6<double>*, 3>, const Vec6<double>*, int,
                        double) override {
    return "it bends";
  }
  Obstacle against_wrench(const Vec6<double>& wrench, const Mat3<double>& axes) override {
    if (length_of(angular(wrench)) > 0.0) return "it has a moment";
    return is_off(axes * linear(wrench)) ? Obstacle{"it acts off the line"} : std::nullopt;
  }
  Obstacle against_coupling(const CouplingSets& coupling) override {
    if (!coupling.axes.empty() || !coupling.matrices.empty()) return "it holds rotations";
    if (!coupling.directions.empty() && coupling.ports[0].node != elements::ground)
      return "it turns with its first end";
    for (const Vec3<double>& d : coupling.directions)
      if (is_off(d)) return "it acts off the line";
    return against_places(coupling.ports);
  }

  std::optional<Vec3<double>> line_;
};

/// The first reason against a set of motions, and the number of elements that passed before it.
struct Verdict {
  Obstacle obstacle;
  std::size_t passed = 0;
};
Verdict judge(const Builder& b, Motion& motion) {
  Verdict v;
  for (const NodePlan& node : b.plan.nodes) {
    if (auto o = motion.against_node(node)) return {"'" + node.name + "': " + *o, v.passed};
    ++v.passed;
  }
  for (std::size_t id = 0; id < b.plan.directory.size() && !v.obstacle; ++id)
    with_element(b.plan.elements, b.plan.directory[id], [&](const auto& e) {
      if (auto o = motion.against(e))
        v.obstacle = "'" + b.plan.element_owner[id] + "': " + *o;
      else
        ++v.passed;
    });
  for (const SignalPlan& s : driving_signals(b.plan))
    if (s.reads_motion() && !v.obstacle)
      if (auto o = motion.against(s.reading)) v.obstacle = "signal '" + s.name + "' reads a motion: " + *o;
  if (!v.obstacle) v.obstacle = motion.against_gravity();
  return v;
}

/// Candidates for the normal of the plane: the ground's axes, the axes of joints, and the normal of the nodes and their
/// attachment points.
std::vector<Vec3<double>> normals(const Builder& b) {
  std::vector<Vec3<double>> list;
  const auto add = [&list](const Vec3<double>& n) {
    const double length = length_of(n);
    if (!(length > 0.0)) return;
    const Vec3<double> unit = (1.0 / length) * n;
    const bool is_known = std::any_of(list.begin(), list.end(), [&unit](const Vec3<double>& other) {
      return length_of(lanes::cross(other, unit)) < small;
    });
    if (!is_known) list.push_back(unit);
  };
  for (int i : {2, 1, 0}) add(Vec3<double>::unit(i));
  std::vector<Vec3<double>> places;
  const auto add_normal_of_places = [&] {
    Vec3<double> far = Vec3<double>::zero(), normal = far;
    for (const Vec3<double>& x : places) {
      const Vec3<double> r = x - places.front();
      if (lanes::dot(r, r) > lanes::dot(far, far)) far = r;
    }
    for (const Vec3<double>& x : places) {
      const Vec3<double> n = lanes::cross(far, Vec3<double>(x - places.front()));
      if (lanes::dot(n, n) > lanes::dot(normal, normal)) normal = n;
    }
    if (length_of(normal) > 1e-6 * lanes::dot(far, far)) add(normal);
  };
  for (const NodePlan& node : b.plan.nodes) places.push_back(node.pose.x);
  add_normal_of_places();
  if (!b.plan.welds.empty()) {  // attachment points of nodes that became part of others
    for (const BodyPlan& body : b.plan.bodies) places.push_back(b.initial_pose(body.frame).x);
    for_each_array(b.plan.elements, [&](const auto& array) {
      for (const auto& e : array)
        for (const Port& p : e.ports)
          if (p.node != elements::ground && p.has_offset) places.push_back(b.initial_pose(p).x);
    });
    add_normal_of_places();
  }
  const auto add_axis_of = [&](const Port& first) {
    if (list.size() > 6) return;
    const Mat3<double> axes = b.initial_pose(first).R;
    add({{axes(0, 2), axes(1, 2), axes(2, 2)}});
  };
  for (const elements::Joint& e : array_of<elements::Joint>(b.plan.elements)) add_axis_of(e.ports[0]);
  for (const WeldPlan& weld : b.plan.welds) add_axis_of(weld.first);
  return list;
}

std::optional<Vec3<double>> line_of(const Builder& b) {
  Vec3<double> far = Vec3<double>::zero();
  const auto look = [&](const Vec3<double>& x) {
    const Vec3<double> r = x - b.plan.nodes.front().pose.x;
    if (lanes::dot(r, r) > lanes::dot(far, far)) far = r;
  };
  for (const NodePlan& node : b.plan.nodes) look(node.pose.x);
  for_each_array(b.plan.elements, [&](const auto& array) {
    if constexpr (std::decay_t<decltype(array)>::value_type::role == elements::Role::coupling)
      for (const auto& e : array)
        for (const Port& p : e.ports) look(b.initial_pose(p).x);
  });
  const double length = length_of(far);
  if (!(length > 0.0)) return std::nullopt;
  return (1.0 / length) * far;
}

void take(Builder& b, Motion& motion) {
  NodeUnknowns& u = b.plan.unknowns;
  u.motions = motion.kind();
  u.count = motion.count();
  u.component = motion.components();
  const Mat3<double> axes = motion.axes();
  bool is_plain = true;
  u.basis.reserve(b.plan.nodes.size());
  for (const NodePlan& node : b.plan.nodes) {
    u.basis.push_back(lanes::transpose(node.pose.R) * axes);
    for (int i = 0; i < 9; ++i) is_plain &= u.basis.back().m[i] == (i % 4 == 0 ? 1.0 : 0.0);
  }
  if (is_plain) u.basis.clear();
  for (JointPlan& j : b.plan.joints) {
    const auto& e = array_of<elements::Joint>(
        b.plan.elements)[static_cast<std::size_t>(b.plan.directory[static_cast<std::size_t>(j.element)].index)];
    std::erase_if(j.rows, [&](int row) { return !motion.keeps(e, row); });
  }
  b.add_reduced_model(axes);
}

/// Reasons against every reduction, whatever the elements are.
Obstacle general_obstacle(const Builder& b) {
  if (b.plan.nodes.empty()) return "there are no nodes";
  if (!b.plan.frames.empty()) return "frames of prescribed motion move in six ways";
  return std::nullopt;
}

/// Decimals with which a number was written, the fewest that give it: 0.25 has two. 16: more than fifteen.
int decimals_of(double x) {
  double power = 1.0;
  for (int d = 0; d < 16; ++d, power *= 10.0)
    if (std::round(x * power) / power == x) return d;
  return 16;
}

/// Relative precision of places and directions if at least six coordinates were written with six to twelve decimals, as
/// programs write them: four units in the last place, which rounding of a place (.87), of an axis and of a body's
/// rotation (1.7 each) adds up to. 0: fewer decimals are written by hand, and meant; others are round-off.
double precision_as_written(const scene::Scene& scene, double size, int& decimals) {
  constexpr int fewest = 6, most = 12;
  constexpr int least_count = 6;  // coordinates with so many decimals: those of two points
  decimals = 0;
  int count = 0;
  const auto look = [&](const Vec3<double>& x) {
    for (int i = 0; i < 3 && decimals <= most; ++i) {
      const int here = decimals_of(x[i]);
      decimals = std::max(decimals, here);
      count += here >= fewest ? 1 : 0;
    }
  };
  for (const scene::Body& body : scene.bodies) look(body.placement.pose.x);
  for (const scene::Node& node : scene.nodes) look(node.placement.pose.x);
  look(scene.gravity);
  if (count < least_count) return 0.0;
  if (decimals < fewest || decimals > most) return 0.0;
  return 4.0 * std::pow(10.0, -decimals) * std::max(1.0, 1.0 / size);
}

}  // namespace

void Builder::choose_unknowns() {
  const Obstacle general = general_obstacle(*this);
  written_precision = precision_as_written(scene, plan.length_scale, written_decimals);
  Motions before = Motions::spatial;
  const auto settle = [&](const char* name, const char* what, const char* why, const Obstacle& beforehand,
                          const std::vector<Vec3<double>>& directions, auto make) {
    std::string reason = beforehand.value_or("everything is at one place");
    bool holds = false;
    std::size_t furthest = 0, tried = 0;
    const auto look = [&](double tolerance) {
      for (std::size_t k = 0; k < directions.size() && !beforehand && !holds; ++k, ++tried) {
        auto motion = make(directions[k], tolerance);
        const Verdict v = judge(*this, motion);
        holds = !v.obstacle;
        if (holds) {
          reason = why;
          if (is_barred(name) || !plan.unknowns.is_whole()) break;
          plan.precision = tolerance > small ? tolerance : 0.0;
          take(*this, motion);
          if (plan.precision > 0.0) {
            char text[160];
            std::snprintf(text, sizeof text,
                          "places are written with %d decimals: within them, with differences of up to %.2g of "
                          "the structure's size, ",
                          written_decimals, motion.largest_difference());
            plan.notes.push_back(text + std::string(why) + ", and are taken so");
          }
        } else if (tried == 0 || v.passed > furthest) {  // the reason reported is that of the direction that passed
                                                         // most elements
          reason = *v.obstacle;
          furthest = v.passed;
        }
      }
    };
    look(small);
    if (written_precision > small) look(written_precision);
    const bool fewer = plan.unknowns.motions != before;
    if (holds && !fewer && !is_barred(name)) reason += "; but fewer unknowns are taken already";
    decide(name, what, fewer, reason);
    before = plan.unknowns.motions;
  };
  const std::vector<Vec3<double>> any{Vec3<double>::zero()};
  std::vector<Vec3<double>> lines, planes;
  if (!general) {
    if (const auto line = line_of(*this)) lines.push_back(*line);
    planes = normals(*this);
  }
  settle("line",
         "one unknown a node. Taken where only springs and forces along one line act, at the origins of nodes on it. "
         "What leaves the line is not seen (springs under pressure that give way sideways); statics looks once, at its "
         "last equilibrium",
         "point masses, springs and loads lie on one line", general, lines,
         [this](const Vec3<double>& d, double tolerance) { return OfPoints(*this, d, tolerance); });
  settle("translation",
         "three unknowns a node, no rotations. Taken where only springs, forces and held displacements act, at the "
         "origins of nodes",
         "forces act at the origins of nodes only, so nothing turns", general, any,
         [this](const Vec3<double>&, double tolerance) { return OfPoints(*this, std::nullopt, tolerance); });
  settle("planar",
         "three unknowns a node, two displacements and a rotation. Taken where geometry, sections, masses, joints, "
         "loads and initial "
         "data are their own mirror images in one plane. What leaves the plane is not seen (buckling sideways, lateral "
         "torsional buckling); statics looks once, at its last equilibrium",
         "geometry, sections, masses, joints, loads and initial data are symmetric about one plane", general, planes,
         [this](const Vec3<double>& n, double tolerance) { return InPlane(*this, n, tolerance); });
}

}  // namespace bough::plan
